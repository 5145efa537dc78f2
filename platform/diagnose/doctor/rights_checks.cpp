// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

#include <sstream>

namespace tactus::doctor
{

namespace
{

constexpr unsigned kCapIpcLock = 14; // Numbers of linux/capability.h.
constexpr unsigned kCapSysNice = 23;

/// State of a capability in words: "held", "not held" or "not known to be held".
std::string capability_in_words(const SystemFiles& files, unsigned capability)
{
    std::istringstream status(files.text("/proc/self/status").value_or(""));
    for (std::string line; std::getline(status, line);)
    {
        constexpr const char* kEffective = "CapEff:\t";
        const auto set =
            line.starts_with(kEffective) ? parse_hexadecimal(line.substr(8)) : std::nullopt;
        if (set)
        {
            return ((*set >> capability) & 1U) != 0 ? "held" : "not held";
        }
    }
    return "not known to be held";
}

std::string limit_in_words(std::optional<std::uint64_t> limit)
{
    if (!limit)
    {
        return "unknown";
    }
    return *limit == kUnlimited ? "unlimited" : std::to_string(*limit);
}

std::vector<std::string> raise_limit(const std::string& user, const std::string& limit)
{
    return {fmt::format("echo {} | sudo tee -a /etc/security/limits.d/tactus.conf",
                        shell_word(fmt::format("{} - {}", user, limit))),
            "exit # Then log in again: limits are set at login."};
}

/// Control group of the process for the cpu controller: its folder below /sys/fs/cgroup.
std::optional<std::string> cpu_group(const SystemFiles& files)
{
    std::istringstream groups(files.text("/proc/self/cgroup").value_or(""));
    for (std::string line; std::getline(groups, line);) // "4:cpu,cpuacct:/user.slice"
    {
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos)
        {
            continue;
        }
        const std::string controllers =
            fmt::format(",{},", line.substr(first + 1, second - first - 1));
        if (controllers.find(",cpu,") != std::string::npos)
        {
            return "cpu" + line.substr(second + 1);
        }
    }
    return std::nullopt;
}

/// Commands that give the control group real-time processor time, without which the right has no
/// effect.
std::vector<std::string> give_share(const SystemFiles& files)
{
    const std::optional<std::string> group = cpu_group(files);
    if (group)
    {
        return {
            fmt::format("echo 950000 | sudo tee {}",
                        shell_word(fmt::format("/sys/fs/cgroup/{}/cpu.rt_runtime_us", *group)))};
    }
    return {"echo $$ | sudo tee /sys/fs/cgroup/cgroup.procs # Moves this shell to the root group."};
}

} // namespace

Finding check_priority(const MachineView& view)
{
    const Measured& measured = view.measured;
    Finding finding{.verdict = Verdict::good};
    const std::string capability = capability_in_words(view.files, kCapSysNice);
    finding.found = fmt::format(
        "SCHED_FIFO {} {}; rtprio limit {}, CAP_SYS_NICE {}", Measured::kFifoPriority,
        measured.fifo_refused.empty() ? "granted"
                                      : fmt::format("refused ({})", measured.fifo_refused),
        limit_in_words(measured.rtprio_limit), capability);
    if (measured.fifo_refused.empty())
    {
        return finding;
    }
    finding.verdict = Verdict::critical;
    const bool is_allowed =
        capability == "held" || measured.rtprio_limit.value_or(0) >= Measured::kFifoPriority;
    finding.found += is_allowed ? ": allowed, so the control group has no share of real time" : "";
    finding.remedy = is_allowed ? give_share(view.files) : raise_limit(measured.user, "rtprio 99");
    return finding;
}

Finding check_memory_lock(const MachineView& view)
{
    const Measured& measured = view.measured;
    Finding finding{.verdict = Verdict::good};
    finding.found = fmt::format("locking all memory {}; memlock limit {}, CAP_IPC_LOCK {}",
                                measured.memory_lock_granted ? "granted" : "refused",
                                measured.memlock_limit && *measured.memlock_limit != kUnlimited
                                    ? fmt::format("{} bytes", *measured.memlock_limit)
                                    : limit_in_words(measured.memlock_limit),
                                capability_in_words(view.files, kCapIpcLock));
    if (!measured.memory_lock_granted)
    {
        finding.verdict = Verdict::critical;
        finding.remedy = raise_limit(measured.user, "memlock unlimited");
    }
    return finding;
}

Finding check_huge_pages(const MachineView& view)
{
    const std::string path = "/sys/kernel/mm/transparent_hugepage/enabled";
    Finding finding{.verdict = Verdict::good};
    const auto choices = view.files.text(path);
    if (!choices && view.files.is_folder("/sys/kernel/mm") && !view.files.is_there(path))
    {
        finding.found = "the kernel makes no huge pages by itself";
        return finding;
    }
    for (const char* choice : {"always", "madvise", "never"})
    {
        if (choices && has_word(*choices, fmt::format("[{}]", choice)))
        {
            finding.found = fmt::format("transparent huge pages: {}", choice);
        }
    }
    if (finding.found.empty())
    {
        return unreadable(view.files, path);
    }
    if (finding.found.ends_with("always"))
    {
        finding.verdict = Verdict::advice;
        finding.remedy = {fmt::format("echo madvise | sudo tee {}", path)};
    }
    return finding;
}

} // namespace tactus::doctor
