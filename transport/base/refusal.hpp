// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

// Any thread except the haptic one: strings allocate.
namespace tactus
{

/// Reason of a refusal: one line for the user, without the program's name and newline. A refusal of
/// real-time settings has one line for each right that was not granted.
struct Refusal
{
    std::string text;
    /// True if an option needs a setting that this machine lacks (RtThread) or contradicts another
    /// option. The program's exit code is then kExitUsage, not kExitFailed.
    bool is_usage{false};
};

} // namespace tactus
