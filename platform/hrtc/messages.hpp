// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"

#include <string>

namespace tactus::hrtc
{

/// A refusal that happened at run time.
[[nodiscard]] Refusal failure(std::string text);

/// Why a run that a signal ended can't be judged.
[[nodiscard]] Refusal interruption();

/// Logs it as an error; returns the code to leave with.
int leave_with(const Refusal& error);

/// Logs what the program couldn't do.
void log_error(const std::string& line);

/// Logs a warning, whatever is in it: file names may hold control characters.
void log_line(const std::string& line);

} // namespace tactus::hrtc
