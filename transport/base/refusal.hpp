// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

// Any thread, except the haptic one: texts allocate.
namespace tactus
{

/// Reason of a refusal: one line for the user, without the program's name and without a line end. A
/// real-time thread's refusal may have several lines, one for each right that was not granted.
struct Refusal
{
    std::string text;
    /// True if an option asked for a setting that this machine lacks (RtThread) or that contradicts
    /// another option. The program then leaves with the exit code of wrong usage, not with that of
    /// a failure.
    bool is_usage{false};
};

} // namespace tactus
