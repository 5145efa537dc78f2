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
    std::string kernel; ///< Release and version as reported by the kernel.
    /// Preemption model in the kernel's version text, such as "PREEMPT_RT"; "none stated" without
    /// one.
    std::string preemption;
    std::string processor;
    unsigned processors{0};
    double load_average{0.0}; ///< Average of the last minute.
    std::string date_utc;     ///< Date as in ISO 8601.
};

[[nodiscard]] Machine describe_machine();

/// Number of periods without a heartbeat after which the loop counts as hanging: 3 with PREEMPT_RT,
/// else 10. Other kernels delay threads by some milliseconds repeatedly.
[[nodiscard]] std::uint32_t silent_periods(const Machine& machine);

} // namespace tactus::hrtc
