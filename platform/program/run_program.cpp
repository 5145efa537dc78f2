// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/run_program.hpp"

#include "platform/program/command_line.hpp"
#include "transport/base/program_log.hpp"

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

} // namespace tactus
