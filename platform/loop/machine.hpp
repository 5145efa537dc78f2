// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <string>

namespace tactus::hrtc
{

/// The machine a run was measured on, for the report's reader.
struct Machine
{
    std::string kernel;     ///< Release and version as the kernel states them.
    std::string preemption; ///< "PREEMPT_RT" or what the kernel's version string says of it.
    std::string processor;
    unsigned processors{0};
    double load_average{0.0}; ///< Of the last minute.
    std::string date_utc;     ///< ISO 8601.
};

[[nodiscard]] Machine describe_machine();

/// For how many periods a loop may be silent here before that is a hang: a kernel without
/// PREEMPT_RT keeps a thread waiting for some milliseconds again and again.
[[nodiscard]] std::uint32_t silent_periods(const Machine& machine);

} // namespace tactus::hrtc
