// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/leave_with.hpp"

#include "transport/base/exit_codes.hpp"
#include "transport/base/program_log.hpp"

namespace tactus::hrtc
{

Refusal interruption()
{
    return {"interrupted; there is no verdict"};
}

int leave_with(const Refusal& error)
{
    log_message(LogLevel::error, "hrtc", error.text);
    return error.is_usage ? kExitUsage : kExitFailed;
}

} // namespace tactus::hrtc
