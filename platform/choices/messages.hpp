// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/program_log.hpp"
#include "transport/base/refusal.hpp"

#include <string>
#include <utility>

namespace tactus::hrtc
{

/// Makes a refusal of an operation that failed at run time.
[[nodiscard]] inline Refusal failure(std::string text)
{
    return {std::move(text)};
}

/// Logs a failed operation of the program as an error.
inline void log_error(const std::string& line)
{
    log_message(LogLevel::error, "hrtc", line);
}

/// Logs a warning. The line may hold control characters, as file names do.
inline void log_line(const std::string& line)
{
    log_message(LogLevel::warning, "hrtc", line);
}

} // namespace tactus::hrtc
