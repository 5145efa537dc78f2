// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/messages.hpp"

#include "transport/base/program_log.hpp"

#include <utility>

namespace tactus::hrtc
{

Refusal failure(std::string text)
{
    return {std::move(text)};
}

void log_error(const std::string& line)
{
    log_message(LogLevel::error, "hrtc", line);
}

void log_line(const std::string& line)
{
    log_message(LogLevel::warning, "hrtc", line);
}

} // namespace tactus::hrtc
