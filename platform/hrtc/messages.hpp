// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"

#include <string>

namespace tactus::hrtc
{

/// A refusal that happened at run time.
[[nodiscard]] Refusal failure(std::string text);

/// Why a run that SIGINT or SIGTERM ended can't be judged.
[[nodiscard]] Refusal interruption();

/// Prints it as one line on stderr; returns the code to leave with.
int leave_with(const Refusal& error);

/// Prints one line on stderr behind the program's name, whatever is in it: file names may hold
/// control characters.
void log_line(std::string line);

} // namespace tactus::hrtc
