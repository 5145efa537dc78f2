// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

namespace tactus::doctor
{

namespace
{

constexpr const char* kActivePreemption = "/sys/kernel/debug/sched/preempt";
constexpr const char* kIrq = "/proc/irq";
constexpr const char* kDefaultAffinity = "/proc/irq/default_smp_affinity";

/// Text in brackets, as in "none voluntary (full)"; empty if there is none.
std::string active_choice(const std::string& choices)
{
    const std::size_t open = choices.find('(');
    const std::size_t close = choices.find(')', open);
    return open == std::string::npos || close == std::string::npos
               ? ""
               : choices.substr(open + 1, close - open - 1);
}

std::string preemption_of(const std::string& version)
{
    for (const char* model : {"PREEMPT_DYNAMIC", "PREEMPT"})
    {
        if (has_word(version, model))
        {
            return model;
        }
    }
    return "no kind of PREEMPT";
}

std::string get_rt_kernel(const std::string& machine)
{
    if (machine == "x86_64" || machine == "aarch64")
    {
        return fmt::format("sudo apt-get install linux-image-rt-{} && sudo reboot",
                           machine == "x86_64" ? "amd64" : "arm64");
    }
    return "scripts/config --enable PREEMPT_RT && make olddefconfig && make # In the kernel's "
           "source tree.";
}

/// Device that the interrupt of a folder serves; empty if it serves none.
std::string device_of(const SystemFiles& files, const std::string& folder)
{
    for (const std::string& name : files.names(folder))
    {
        if (files.is_folder(folder + "/" + name))
        {
            return name;
        }
    }
    return "";
}

/// Processors that get an interrupt; if unknown, those that may get it.
std::optional<ProcessorSet> targets_of(const SystemFiles& files, const std::string& folder)
{
    for (const char* name : {"/effective_affinity_list", "/smp_affinity_list"})
    {
        const auto list = files.text(folder + name);
        const auto targets = list ? parse_processor_list(*list) : std::nullopt;
        if (targets && targets->any())
        {
            return targets;
        }
    }
    return std::nullopt;
}

struct InterruptCount
{
    std::size_t with_device{0};
    std::size_t untold{0}; ///< Interrupts with unknown processors.
    std::size_t here{0};   ///< Interrupts on the loop's processor.
    std::string
        examples; ///< Text that names up to three of the interrupts on the loop's processor.
};

InterruptCount count_interrupts(const SystemFiles& files, int cpu)
{
    constexpr std::size_t kExamples = 3;
    InterruptCount count;
    for (const std::string& number : files.names(kIrq))
    {
        const std::string folder = fmt::format("{}/{}", kIrq, number);
        const std::string device = parse_integer(number) ? device_of(files, folder) : "";
        if (device.empty())
        {
            continue;
        }
        ++count.with_device;
        const auto targets = targets_of(files, folder);
        count.untold += targets ? 0U : 1U;
        if (!targets || !targets->test(static_cast<std::size_t>(cpu)))
        {
            continue;
        }
        if (++count.here <= kExamples)
        {
            count.examples +=
                fmt::format("{}{} {}", count.here == 1 ? "" : ", ", number, shown(device));
        }
    }
    count.examples += count.here > kExamples ? ", ..." : "";
    return count;
}

/// Commands that move the interrupts. They disable irqbalance first, which would undo the move.
std::vector<std::string> move_interrupts(const SystemFiles& files, const ProcessorSet& others)
{
    std::vector<std::string> commands;
    if (files.is_there("/usr/sbin/irqbalance"))
    {
        commands.emplace_back("sudo systemctl disable --now irqbalance");
    }
    commands.push_back(
        fmt::format("echo {} | sudo tee {}", processor_mask(others), kDefaultAffinity));
    commands.push_back(
        fmt::format("for i in /proc/irq/[0-9]*/smp_affinity_list; do echo {} | sudo tee $i; done",
                    processor_list(others)));
    return commands;
}

} // namespace

Finding check_preemption(const MachineView& view)
{
    Finding finding{.verdict = Verdict::advice};
    const std::string version =
        view.files.text("/proc/version").value_or(view.measured.kernel_version);
    if (view.files.text("/sys/kernel/realtime") == "1" || has_word(version, "PREEMPT_RT"))
    {
        finding.verdict = Verdict::good;
        finding.found = "the kernel has PREEMPT_RT";
        return finding;
    }
    if (!version.starts_with("Linux") && view.measured.kernel_version.empty())
    {
        return unreadable(view.files, "/proc/version");
    }
    finding.found = fmt::format("the kernel has {}, not PREEMPT_RT", preemption_of(version));
    finding.remedy = {get_rt_kernel(view.measured.machine)};
    const std::string active = active_choice(view.files.text(kActivePreemption).value_or(""));
    if (!active.empty())
    {
        finding.found += fmt::format(", and runs as {}", shown(active));
    }
    if (!active.empty() && active != "full")
    {
        finding.remedy.push_back(
            fmt::format("echo full | sudo tee {} # Until then.", kActivePreemption));
    }
    return finding;
}

Finding check_throttling(const MachineView& view)
{
    const std::string folder = "/proc/sys/kernel/";
    Finding finding{.verdict = Verdict::advice,
                    .remedy = {"sudo sysctl -w kernel.sched_rt_runtime_us=-1"}};
    const auto read = [&](const char* name) -> std::optional<std::int64_t>
    {
        const auto text = view.files.text(folder + name);
        return text ? parse_integer(*text) : std::nullopt;
    };
    const auto runtime = read("sched_rt_runtime_us");
    const auto period = read("sched_rt_period_us");
    if (!runtime || *runtime < -1)
    {
        return unreadable(view.files, folder + "sched_rt_runtime_us");
    }
    if (!period || *period <= 0)
    {
        return unreadable(view.files, folder + "sched_rt_period_us");
    }
    if (*runtime == -1 || *runtime >= *period)
    {
        finding.verdict = Verdict::good;
        finding.found = "real-time threads are never throttled";
        finding.remedy.clear();
        return finding;
    }
    finding.verdict = *runtime == 0 ? Verdict::critical : Verdict::advice;
    finding.found = fmt::format("real-time threads get {} of every {} us", *runtime, *period);
    return finding;
}

Finding check_compaction(const MachineView& view)
{
    const std::string file = "/proc/sys/vm/compact_unevictable_allowed";
    Finding finding{.verdict = Verdict::advice,
                    .found = "the kernel may move locked memory to make room for large blocks",
                    .remedy = {"echo vm.compact_unevictable_allowed=0 | sudo tee "
                               "/etc/sysctl.d/61-tactus.conf",
                               "sudo sysctl --system"}};
    const auto text = view.files.text(file);
    const auto allowed = text ? parse_integer(*text) : std::nullopt;
    if (!allowed)
    {
        return unreadable(view.files, file);
    }
    if (*allowed == 0)
    {
        finding.verdict = Verdict::good;
        finding.found = "the kernel does not move locked memory";
        finding.remedy.clear();
    }
    return finding;
}

Finding check_isolation(const MachineView& view)
{
    const std::string folder = "/sys/devices/system/cpu/";
    Finding finding{.verdict = Verdict::advice};
    const auto list = view.files.text(folder + "isolated");
    const auto isolated = list ? parse_processor_list(*list) : std::nullopt;
    if (!isolated)
    {
        return unreadable(view.files, folder + "isolated");
    }
    const auto online = online_processors(view.files);
    const auto cpu = chosen_or_highest(view);
    if (!online || !cpu)
    {
        return unreadable(view.files, folder + "online");
    }

    if (isolated->any() && !view.cpu)
    {
        finding.found =
            fmt::format("{} isolated, but none is chosen", processors_in_words(*isolated));
        finding.remedy = {fmt::format("hrtc doctor --cpu {0} # And hrtc --cpu {0}.",
                                      lowest_of(*isolated).value_or(0))};
        return finding;
    }
    if (isolated->test(static_cast<std::size_t>(*cpu)))
    {
        const auto quiet = parse_processor_list(view.files.text(folder + "nohz_full").value_or(""));
        const bool ticks = !quiet || !quiet->test(static_cast<std::size_t>(*cpu));
        finding.verdict = Verdict::good;
        finding.found =
            fmt::format("processor {} is isolated, {} a tick", *cpu, ticks ? "with" : "without");
        return finding;
    }
    finding.found = isolated->any() ? fmt::format("{} isolated, but not {}",
                                                  processors_in_words(*isolated), *cpu)
                                    : "no processor is isolated";
    const ProcessorSet others = *online & ~set_of(*cpu);
    finding.remedy = {
        others.none()
            ? "lscpu --online --extended # One processor is too few; the loop needs another one."
            : add_to_kernel_line(fmt::format(
                  "isolcpus=managed_irq,domain,{0} nohz_full={0} rcu_nocbs={0} irqaffinity={1}",
                  *cpu, processor_list(others)))};
    return finding;
}

Finding check_interrupts(const MachineView& view)
{
    Finding finding{.verdict = Verdict::advice};
    const auto online = online_processors(view.files);
    if (!online)
    {
        return unreadable(view.files, "/sys/devices/system/cpu/online");
    }
    if (!view.cpu)
    {
        finding.found = "no processor is chosen for the loop, so any interrupt may hit it";
        finding.remedy = {fmt::format("hrtc doctor --cpu {}", highest_of(*online).value_or(0))};
        return finding;
    }
    const auto text = view.files.text(kDefaultAffinity);
    const auto by_default = text ? parse_processor_mask(*text) : std::nullopt;
    if (!by_default || by_default->none())
    {
        return unreadable(view.files, kDefaultAffinity);
    }

    const InterruptCount count = count_interrupts(view.files, *view.cpu);
    const bool new_ones_come = by_default->test(static_cast<std::size_t>(*view.cpu));
    finding.found = fmt::format("{} of {} interrupts go to processor {}{}; new ones {}", count.here,
                                count.with_device, *view.cpu,
                                count.here > 0 ? fmt::format(" ({})", count.examples) : "",
                                new_ones_come ? "may" : "do not");
    if (count.untold > 0)
    {
        finding.verdict = count.here > 0 || new_ones_come ? Verdict::advice : Verdict::unknown;
        finding.found += fmt::format("; {} with an unknown target", count.untold);
    }
    else if (count.here == 0 && !new_ones_come)
    {
        finding.verdict = Verdict::good;
        return finding;
    }
    const ProcessorSet others = *online & ~set_of(*view.cpu);
    finding.remedy =
        others.none()
            ? std::vector<std::string>{"lscpu --online --extended # One processor is too few."}
            : move_interrupts(view.files, others);
    return finding;
}

} // namespace tactus::doctor
