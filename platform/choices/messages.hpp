// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <string>

namespace tactus::hrtc
{

/// A refusal that happened at run time.
[[nodiscard]] Refusal failure(std::string text);

/// Logs what the program couldn't do.
void log_error(const std::string& line);

/// Logs a warning, whatever is in it: file names may hold control characters.
void log_line(const std::string& line);

} // namespace tactus::hrtc
