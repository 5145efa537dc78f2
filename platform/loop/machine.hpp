// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <string>

namespace tactus::hrtc
{

/// The machine of a run, for its report.
struct Machine
{
    std::string kernel;     ///< Release and version as reported by the kernel.
    std::string preemption; ///< "PREEMPT_RT" or the text of the kernel's version string.
    std::string processor;
    unsigned processors{0};
    double load_average{0.0}; ///< Average of the last minute.
    std::string date_utc;     ///< Date as in ISO 8601.
};

[[nodiscard]] Machine describe_machine();

/// Number of periods without a beat that count as a hang on this machine: a kernel without
/// PREEMPT_RT delays threads by some milliseconds repeatedly.
[[nodiscard]] std::uint32_t silent_periods(const Machine& machine);

} // namespace tactus::hrtc
