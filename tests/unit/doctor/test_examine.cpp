// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/doctor.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string_view>

namespace tactus::doctor
{

namespace
{

/// Checks that judge by what was tried alone.
constexpr std::array<std::string_view, 5> kWithoutFiles{"priority", "memlock", "timer",
                                                        "float-control", "dds-configuration"};

bool is_clean(const std::string& text)
{
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7F; });
}

/// What holds for every finding on every machine.
void expect_sound(const std::vector<Finding>& findings)
{
    std::set<std::string> names;
    for (const Finding& finding : findings)
    {
        SCOPED_TRACE(finding.name);
        EXPECT_TRUE(names.insert(finding.name).second);
        EXPECT_TRUE(is_clean(finding.found)) << finding.found;
        EXPECT_TRUE(is_clean(finding.why));
        EXPECT_EQ(finding.remedy.empty(), finding.verdict == Verdict::good) << finding.found;
        EXPECT_TRUE(std::ranges::all_of(finding.remedy, is_clean));
    }
    EXPECT_EQ(findings.size(), 17U);
}

void expect_unknown_where_files_tell(const std::vector<Finding>& findings)
{
    for (const Finding& finding : findings)
    {
        const bool has_files = std::ranges::count(kWithoutFiles, finding.name) == 0;
        EXPECT_EQ(finding.verdict == Verdict::unknown, has_files)
            << finding.name << ": " << finding.found;
    }
}

TEST(Examine, has_nothing_to_mend_on_a_good_machine)
{
    MadeUpMachine machine;
    make_good(machine);
    const std::vector<Finding> findings = examine(machine.view());
    expect_sound(findings);
    for (const Finding& finding : findings)
    {
        EXPECT_EQ(finding.verdict, Verdict::good) << finding.name << ": " << finding.found;
    }
    EXPECT_EQ(count_of(findings, Verdict::good), 17U);
}

TEST(Examine, says_of_a_machine_without_files_what_is_missing)
{
    MadeUpMachine machine;
    machine.measured.clock_resolution_ns = 1;
    for (const std::optional<int> cpu : {std::optional<int>(), std::optional(0)})
    {
        machine.cpu = cpu;
        const std::vector<Finding> findings = examine(machine.view());
        expect_sound(findings);
        expect_unknown_where_files_tell(findings);
        for (const Finding& finding : findings)
        {
            EXPECT_TRUE(finding.verdict == Verdict::good ||
                        finding.found.ends_with(" is not there"))
                << finding.found;
        }
    }
}

/// Every file of a good machine holds the same garbage.
TEST(Examine, takes_garbage_for_nothing_good)
{
    const std::string huge(1 << 20, '9');
    for (const std::string& garbage :
         {std::string(), std::string("\n"), std::string("-"), std::string("\xff\xfe\0\x1b[2J", 8),
          std::string(","), std::string("0x"), std::string(5000, ','), std::string(70'000, '('),
          huge})
    {
        SCOPED_TRACE(garbage.substr(0, 8));
        MadeUpMachine machine;
        make_good(machine);
        machine.measured.kernel_version = "";
        machine.measured.clock_calls.reset();
        for (const std::string& path : machine.paths())
        {
            machine.put(path, garbage);
        }
        const std::vector<Finding> findings = examine(machine.view());
        expect_sound(findings);
        expect_unknown_where_files_tell(findings);
    }
}

TEST(Examine, survives_bytes_at_random)
{
    const unsigned seed = 20260102;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    MadeUpMachine machine;
    make_good(machine);
    const std::vector<std::string> paths = machine.paths();
    const std::string letters = "0123456789,-()[]<>abcfx/ \n\x80";
    for (int i = 0; i < 100; ++i)
    {
        for (const std::string& path : paths)
        {
            std::string bytes(random() % 12, '\0');
            std::ranges::generate(bytes, [&] { return letters[random() % letters.size()]; });
            machine.put(path, bytes);
        }
        machine.cpu = i % 2 == 0 ? std::optional(static_cast<int>(random() % 1024)) : std::nullopt;
        expect_sound(examine(machine.view()));
    }
}

/// Each thing without which the loop can not run, by itself.
TEST(Examine, calls_critical_what_the_loop_can_not_be_without)
{
    const std::map<std::string, std::function<void(MadeUpMachine&)>> faults{
        {"priority", [](MadeUpMachine& m) { m.measured.fifo_refused = "EPERM"; }},
        {"memlock", [](MadeUpMachine& m) { m.measured.memory_lock_granted = false; }},
        {"clock-source", [](MadeUpMachine& m) { m.measured.clock_calls = 1; }},
        {"timer", [](MadeUpMachine& m) { m.measured.clock_resolution_ns = 4'000'000; }},
        {"float-control", [](MadeUpMachine& m) { m.measured.float_control_is_default = false; }},
        {"rt-throttling",
         [](MadeUpMachine& m) { m.put("/proc/sys/kernel/sched_rt_runtime_us", "0"); }},
        {"dds-interface", [](MadeUpMachine& m) { m.take_away("/sys/class/net/lo"); }},
        {"dds-configuration", [](MadeUpMachine& m) { m.measured.dds_uri = "/gone.xml"; }}};
    for (const auto& [name, break_it] : faults)
    {
        MadeUpMachine machine;
        make_good(machine);
        break_it(machine);
        const std::vector<Finding> findings = examine(machine.view());
        expect_sound(findings);
        EXPECT_EQ(count_of(findings, Verdict::good), 16U) << name;
        const auto found = std::ranges::find(findings, name, &Finding::name);
        ASSERT_NE(found, findings.end()) << name;
        EXPECT_EQ(found->verdict, Verdict::critical) << found->found;
    }
}

TEST(Examine, only_advises_where_the_loop_runs_all_the_same)
{
    MadeUpMachine machine;
    make_good(machine);
    machine.take_away("/sys/kernel/realtime");
    machine.put("/proc/version", "Linux version 6.1 #1 SMP PREEMPT_DYNAMIC");
    machine.put("/proc/sys/kernel/sched_rt_runtime_us", "950000");
    machine.put("/proc/sys/vm/compact_unevictable_allowed", "1");
    machine.put("/sys/devices/system/cpu/isolated", "");
    machine.put("/proc/irq/default_smp_affinity", "f");
    machine.put("/sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "powersave");
    machine.put("/sys/devices/system/cpu/cpu3/cpuidle/state1/latency", "890");
    machine.put("/sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "2-3");
    machine.put("/sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never");
    machine.put("/proc/sys/net/core/rmem_max", "212992");
    const std::vector<Finding> findings = examine(machine.view());
    expect_sound(findings);
    EXPECT_EQ(count_of(findings, Verdict::advice), 10U);
    EXPECT_EQ(count_of(findings, Verdict::good), 7U);
}

} // namespace

} // namespace tactus::doctor
