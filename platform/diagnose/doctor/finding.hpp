// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

/// Result of one check. All texts are printable ASCII without line ends.
struct Finding
{
    std::string name; ///< Name of the check: lower-case words joined by '-'.
    Verdict verdict{Verdict::unknown};
    std::string found;
    std::string why;                 ///< Effect on the loop.
    std::vector<std::string> remedy; ///< Shell commands, in order; empty if the verdict is good.
    /// True if an option requests this check: a good finding is then shown in full, too.
    bool is_asked_for{false};
};

} // namespace tactus::doctor
