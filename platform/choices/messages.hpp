// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <string>

namespace tactus::hrtc
{

/// Makes a refusal of an operation that failed at run time.
[[nodiscard]] Refusal failure(std::string text);

/// Logs a failed operation of the program as an error.
void log_error(const std::string& line);

/// Logs a warning. The line may hold control characters, as file names do.
void log_line(const std::string& line);

} // namespace tactus::hrtc
