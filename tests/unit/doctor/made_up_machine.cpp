// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tactus::doctor
{
namespace
{

std::filesystem::path make_folder()
{
    std::string pattern = (std::filesystem::temp_directory_path() / "doctor-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
    {
        ADD_FAILURE() << "no folder like " << pattern;
        std::abort();
    }
    return pattern;
}

void replace_all(std::string& text, const std::string& from, const std::string& to)
{
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size()))
    {
        text.replace(at, from.size(), to);
    }
}

} // namespace

MadeUpMachine::MadeUpMachine() : root_(make_folder()), files_(root_) {}

MadeUpMachine::~MadeUpMachine()
{
    std::error_code error;
    std::filesystem::remove_all(root_, error);
}

void MadeUpMachine::put(const std::string& path, const std::string& content) const
{
    const std::filesystem::path full = root_ / path.substr(1);
    std::filesystem::create_directories(full.parent_path());
    std::ofstream(full, std::ios::binary) << content;
}

void MadeUpMachine::put_folder(const std::string& path) const
{
    std::filesystem::create_directories(root_ / path.substr(1));
}

void MadeUpMachine::take_away(const std::string& path) const
{
    EXPECT_GT(std::filesystem::remove_all(root_ / path.substr(1)), 0U) << path;
}

std::string MadeUpMachine::content_of(const std::string& path) const
{
    std::ostringstream text;
    text << std::ifstream(root_ / path.substr(1)).rdbuf();
    return text.str();
}

std::vector<std::string> MadeUpMachine::paths() const
{
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root_))
    {
        if (entry.is_regular_file())
        {
            paths.push_back("/" + std::filesystem::relative(entry.path(), root_).string());
        }
    }
    return paths;
}

void MadeUpMachine::run(const std::string& command) const
{
    std::string script = command.substr(0, command.find(" && sudo update-grub"));
    replace_all(script, "sudo ", "");
    for (const std::string top : {"/proc/", "/sys/", "/etc/"})
    {
        replace_all(script, " " + top, " " + root_.string() + top);
    }
    put("/script", script + '\n');
    const std::string line = "bash " + (root_ / "script").string() + " >/dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << script;
    take_away("/script");
}

void make_good(MadeUpMachine& machine)
{
    machine.put("/proc/version", "Linux version 6.1.0-rt (gcc) #1 SMP PREEMPT_RT Debian 6.1\n");
    machine.put("/sys/kernel/realtime", "1\n");
    machine.put("/proc/cmdline", "quiet isolcpus=3\n");
    machine.put("/proc/sys/kernel/sched_rt_runtime_us", "-1\n");
    machine.put("/proc/sys/kernel/sched_rt_period_us", "1000000\n");
    machine.put("/proc/sys/vm/compact_unevictable_allowed", "0\n");
    machine.put("/proc/self/status", "Name:\thrtc\nCapEff:\t0000000000000000\n");
    machine.put("/proc/self/cgroup", "4:cpu,cpuacct:/user.slice\n0::/user.slice\n");
    const std::string cpus = "/sys/devices/system/cpu/";
    machine.put(cpus + "online", "0-3\n");
    machine.put(cpus + "isolated", "3\n");
    machine.put(cpus + "nohz_full", "3\n");
    machine.put(cpus + "smt/active", "0\n");
    machine.put(cpus + "cpuidle/current_driver", "intel_idle\n");
    for (const std::string cpu : {"cpu0", "cpu1", "cpu2", "cpu3"})
    {
        machine.put(cpus + cpu + "/cpufreq/scaling_governor", "performance\n");
        machine.put(cpus + cpu + "/topology/thread_siblings_list", cpu.substr(3) + "\n");
        machine.put(cpus + cpu + "/cpuidle/state0/latency", "0\n");
        machine.put(cpus + cpu + "/cpuidle/state0/disable", "0\n");
        machine.put(cpus + cpu + "/cpuidle/state1/latency", "2\n");
        machine.put(cpus + cpu + "/cpuidle/state1/disable", "0\n");
    }
    // The value is 2e9: no request.
    machine.put("/dev/cpu_dma_latency", std::string("\x00\x94\x35\x77", 4));
    machine.put("/proc/irq/default_smp_affinity", "7\n");
    machine.put("/proc/irq/24/smp_affinity_list", "0-2\n");
    machine.put("/proc/irq/24/effective_affinity_list", "1\n");
    machine.put_folder("/proc/irq/24/eth0");
    machine.put("/sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
    machine.put("/sys/devices/system/clocksource/clocksource0/available_clocksource",
                "tsc hpet acpi_pm \n");
    machine.put("/sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never\n");
    machine.put("/sys/class/net/lo/flags", "0x9\n");
    machine.put("/sys/class/net/lo/operstate", "unknown\n");
    machine.put("/sys/class/net/eth0/flags", "0x1003\n");
    machine.put("/sys/class/net/eth0/operstate", "up\n");
    machine.put("/proc/sys/net/core/rmem_max", "1048576\n");
    machine.put("/proc/sys/net/core/wmem_max", "212992\n");
    machine.cpu = 3;
    machine.measured.user = "hand";
    machine.measured.machine = "x86_64";
    machine.measured.kernel_version = "#1 SMP PREEMPT_RT Debian 6.1";
    machine.measured.rtprio_limit = 99;
    machine.measured.memlock_limit = kUnlimited;
    machine.measured.clock_calls = 0;
    machine.measured.clock_resolution_ns = 1;
}

} // namespace tactus::doctor
