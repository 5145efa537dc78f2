// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/run_program.hpp"

#include "platform/program/command_line.hpp"
#include "transport/base/exit_codes.hpp"
#include "transport/base/program_log.hpp"

#include <cstdio>
#include <exception>
#include <new>
#include <string>

namespace tactus
{

int run_program(std::string_view name, std::string_view memory_hint,
                const std::function<int()>& body)
{
    try
    {
        return body();
    }
    catch (const std::bad_alloc& error)
    {
        log_message(LogLevel::error, name,
                    memory_hint.empty() ? error.what()
                                        : "not enough memory; " + std::string(memory_hint));
    }
    catch (const std::exception& error)
    {
        log_message(LogLevel::error, name, error.what());
    }
    return kExitFailed;
}

void print_out(std::string_view text) noexcept
{
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
    static_cast<void>(std::fflush(stdout));
}

} // namespace tactus

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
