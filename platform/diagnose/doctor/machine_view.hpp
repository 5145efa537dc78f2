// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/measured.hpp"
#include "platform/diagnose/doctor/system_files.hpp"
#include "platform/diagnose/doctor/system_text.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::doctor
{

/// Verdict of a check.
enum class Verdict : std::uint8_t
{
    good,
    advice,   ///< The loop runs, but the machine makes it late more often than necessary.
    critical, ///< The loop can't be a real-time thread, can't keep its period, or has no DDS.
    unknown,  ///< The check's source is missing or invalid; `found` names it.
};

inline constexpr std::array<const char*, 4> kVerdictNames{"good", "advice", "critical", "unknown"};

[[nodiscard]] constexpr const char* name_of(Verdict verdict) noexcept
{
    return kVerdictNames[static_cast<std::size_t>(verdict)];
}

/// Result of one check. All texts are printable ASCII without line ends. examine() adds the name
/// and the effect from its table.
struct Finding
{
    std::string name{}; ///< Name of the check: lower-case words joined by '-'.
    Verdict verdict{Verdict::unknown};
    std::string found{};
    std::string why{};                 ///< Effect on the loop.
    std::vector<std::string> remedy{}; ///< Shell commands, in order; empty if the verdict is good.
    /// True if an option requests this check: a good finding is then shown in full, too.
    bool is_asked_for{false};
};

/// Data on the machine for the checks.
struct MachineView
{
    const SystemFiles& files;
    const Measured& measured;
    std::optional<int> cpu; ///< Processor that the loop will be pinned to; none: not chosen.
};

/// Online processors; none if the kernel does not report them.
[[nodiscard]] std::optional<ProcessorSet> online_processors(const SystemFiles& files);

/// Processors of the loop: the chosen one, or all online ones.
[[nodiscard]] std::optional<ProcessorSet> loop_processors(const MachineView& view);

/// Processor given by `--cpu`; otherwise the highest online one, the best choice for `--cpu`. None
/// if unknown.
[[nodiscard]] std::optional<int> chosen_or_highest(const MachineView& view);

/// Text like "processors 0-3" or "processor 2".
[[nodiscard]] std::string processors_in_words(const ProcessorSet& set);

/// Finding with the verdict unknown, because `path` can't be read or has invalid content.
[[nodiscard]] Finding unreadable(const SystemFiles& files, const std::string& path);

/// Command that adds arguments to the kernel's line permanently, in Debian's way.
[[nodiscard]] std::string add_to_kernel_line(const std::string& arguments);

} // namespace tactus::doctor
