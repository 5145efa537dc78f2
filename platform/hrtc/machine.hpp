// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

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

} // namespace tactus::hrtc
