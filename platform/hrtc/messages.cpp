// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/messages.hpp"

#include "host_tools/cli/command_line.hpp"
#include "platform/base/printable.hpp"

#include <fmt/format.h>

#include <cstdio>
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
    log_line(error.text);
    return error.is_usage ? kExitUsage : kExitFailed;
}

void log_line(std::string line)
{
    fmt::print(stderr, "hrtc: {}\n", printable_line(line));
}

} // namespace tactus::hrtc
