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

/// What a check makes of the machine.
enum class Verdict : std::uint8_t
{
    good,
    advice,   ///< The loop runs; the machine makes it late more often than it has to.
    critical, ///< The loop can't run as a real-time thread, can't keep its period or has no DDS.
    unknown,  ///< What the check reads is missing or makes no sense; `found` names it.
};

inline constexpr std::array<const char*, 4> kVerdictNames{"good", "advice", "critical", "unknown"};

[[nodiscard]] constexpr const char* name_of(Verdict verdict) noexcept
{
    return kVerdictNames[static_cast<std::size_t>(verdict)];
}

/// What one check has to say. All texts are printable ASCII without line ends.
struct Finding
{
    std::string name; ///< Of the check: lower-case words joined by '-'.
    Verdict verdict{Verdict::unknown};
    std::string found;
    std::string why;                 ///< What it means for the loop.
    std::vector<std::string> remedy; ///< Commands for a shell, in order; empty when it is good.
    bool is_asked_for{false};        ///< By an option of its own: it is shown when it is good, too.
};

} // namespace tactus::doctor
