// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/messages.hpp"

#include "host_tools/cli/command_line.hpp"
#include "platform/base/program_log.hpp"

#include <utility>

namespace tactus::hrtc
{

Refusal failure(std::string text)
{
    return {std::move(text)};
}

Refusal interruption()
{
    return failure("interrupted; nothing is judged");
}

int leave_with(const Refusal& error)
{
    log_error(error.text);
    return error.is_usage ? kExitUsage : kExitFailed;
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
