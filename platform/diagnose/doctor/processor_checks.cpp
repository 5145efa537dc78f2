// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tactus::doctor
{

namespace
{

constexpr const char* kOnline = "/sys/devices/system/cpu/online";

std::string folder_of(std::size_t processor)
{
    return fmt::format("/sys/devices/system/cpu/cpu{}", processor);
}

/// Folder of one processor, or the pattern of all.
std::string folders_of(const MachineView& view)
{
    return view.cpu ? folder_of(static_cast<std::size_t>(*view.cpu))
                    : "/sys/devices/system/cpu/cpu[0-9]*";
}

bool is_name_of_governor(const std::string& text)
{
    return !text.empty() && text.size() < 16 &&
           std::ranges::all_of(text, [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
}

/// Longest wake-up time of the states that aren't disabled. None if one can't be read; its path is
/// then in `unreadable_path`.
std::optional<std::int64_t> deepest_wake_us(const SystemFiles& files, std::size_t processor,
                                            std::string& unreadable_path)
{
    std::int64_t deepest_us = 0;
    const std::string folder = fmt::format("{}/cpuidle", folder_of(processor));
    for (const std::string& state : files.names(folder))
    {
        const std::string path = fmt::format("{}/{}", folder, state);
        if (!state.starts_with("state") || files.text(path + "/disable").value_or("0") != "0")
        {
            continue;
        }
        const auto text = files.text(path + "/latency");
        const auto latency_us = text ? parse_integer(*text) : std::nullopt;
        if (!latency_us || *latency_us < 0)
        {
            unreadable_path = path + "/latency";
            return std::nullopt;
        }
        deepest_us = std::max(deepest_us, *latency_us);
    }
    return deepest_us;
}

/// Latency limit in us of the process that holds /dev/cpu_dma_latency open. States with a longer
/// wake-up are not entered. None if it can't be read.
std::optional<std::int64_t> wake_asked_for_us(const SystemFiles& files)
{
    const auto bytes = files.bytes("/dev/cpu_dma_latency");
    if (!bytes || bytes->size() != 4)
    {
        return std::nullopt;
    }
    std::uint32_t value = 0; // Little-endian, as on all supported processors.
    for (std::size_t i = 4; i-- > 0;)
    {
        value = (value << 8U) | static_cast<unsigned char>((*bytes)[i]);
    }
    return value > 0x7FFFFFFFU ? std::nullopt : std::optional(std::int64_t{value});
}

} // namespace

Finding check_governor(const MachineView& view)
{
    Finding finding{
        .verdict = Verdict::advice,
        .remedy = {fmt::format("echo performance | sudo tee {}/cpufreq/scaling_governor",
                               folders_of(view))}};
    const auto processors = loop_processors(view);
    if (!processors || !online_processors(view.files))
    {
        return unreadable(view.files, kOnline);
    }
    std::map<std::string, ProcessorSet> by_governor;
    for (std::size_t i = 0; i < processors->size(); ++i)
    {
        const std::string path = fmt::format("{}/cpufreq/scaling_governor", folder_of(i));
        if (!processors->test(i) || !view.files.is_there(path))
        {
            continue;
        }
        const std::string governor = view.files.text(path).value_or("");
        if (!is_name_of_governor(governor))
        {
            return unreadable(view.files, path);
        }
        by_governor[governor].set(i);
    }
    for (const auto& [governor, set] : by_governor)
    {
        finding.found += fmt::format("{}{}: {}", finding.found.empty() ? "" : "; ",
                                     processors_in_words(set), governor);
    }
    if (by_governor.empty())
    {
        finding.found =
            fmt::format("{} without a governor: the clock rate is fixed or set by the hypervisor",
                        processors_in_words(*processors));
    }
    if (by_governor.empty() || (by_governor.size() == 1 && by_governor.contains("performance")))
    {
        finding.verdict = Verdict::good;
        finding.remedy.clear();
    }
    return finding;
}

Finding check_idle_states(const MachineView& view)
{
    Finding finding{.verdict = Verdict::advice};
    const auto processors = loop_processors(view);
    if (!processors || !online_processors(view.files))
    {
        return unreadable(view.files, kOnline);
    }
    std::int64_t deepest_us = 0;
    for (std::size_t i = 0; i < processors->size(); ++i)
    {
        std::string path;
        const auto wake_us = processors->test(i) ? deepest_wake_us(view.files, i, path) : 0;
        if (!wake_us)
        {
            return unreadable(view.files, path);
        }
        deepest_us = std::max(deepest_us, *wake_us);
    }
    const auto driver = view.files.text("/sys/devices/system/cpu/cpuidle/current_driver");
    finding.found =
        fmt::format("driver {}, up to {} us to wake", shown(driver.value_or("none")), deepest_us);
    const auto asked_us = wake_asked_for_us(view.files);
    if (asked_us && *asked_us < deepest_us)
    {
        deepest_us = *asked_us;
        finding.found += fmt::format(", limited to {} us by /dev/cpu_dma_latency", *asked_us);
    }
    if (deepest_us <= kMostWake_us)
    {
        finding.verdict = Verdict::good;
        return finding;
    }
    finding.remedy = {fmt::format("for s in {}/cpuidle/state*; do [ $(cat $s/latency) -le {} ] || "
                                  "echo 1 | sudo tee $s/disable; done",
                                  folders_of(view), kMostWake_us)};
    return finding;
}

Finding check_siblings(const MachineView& view)
{
    Finding finding{.verdict = Verdict::advice};
    if (!view.cpu)
    {
        const std::string path = "/sys/devices/system/cpu/smt/active";
        const auto active = view.files.text(path);
        if (active != "0" && active != "1")
        {
            return unreadable(view.files, path);
        }
        finding.verdict = active == "0" ? Verdict::good : Verdict::advice;
        finding.found = active == "0" ? "no two processors share a core" : "processors share cores";
        if (active == "1")
        {
            finding.remedy = {"echo off | sudo tee /sys/devices/system/cpu/smt/control"};
        }
        return finding;
    }
    const auto own = static_cast<std::size_t>(*view.cpu);
    const std::string path = fmt::format("{}/topology/thread_siblings_list", folder_of(own));
    const auto list = view.files.text(path);
    const auto siblings = list ? parse_processor_list(*list) : std::nullopt;
    if (!siblings || !siblings->test(own))
    {
        return unreadable(view.files, path);
    }
    const ProcessorSet others = *siblings & ~set_of(*view.cpu);
    finding.verdict = others.none() ? Verdict::good : Verdict::advice;
    finding.found = others.none() ? fmt::format("processor {} has a core to itself", own)
                                  : fmt::format("processor {} shares its core with {}", own,
                                                processor_list(others));
    for (std::size_t i = 0; i < others.size(); ++i)
    {
        if (others.test(i))
        {
            finding.remedy.push_back(fmt::format("echo 0 | sudo tee {}/online", folder_of(i)));
        }
    }
    return finding;
}

} // namespace tactus::doctor
