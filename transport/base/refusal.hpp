// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

// Any thread, but not the haptic one: texts allocate.
namespace tactus
{

/// Why something was refused: one line for the user, without the program's name and without a line
/// end. A real-time thread's may have several lines, one for each thing that was not granted.
struct Refusal
{
    std::string text;
    /// An option asked for what this machine can't give (RtThread) or for what contradicts another
    /// one: the program leaves with the exit code of wrong usage, not with that of a failure.
    bool is_usage{false};
};

} // namespace tactus
