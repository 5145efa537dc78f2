// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/run_program.hpp"

#include "host_tools/cli/command_line.hpp"
#include "platform/base/printable.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

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
        memory_hint.empty() ? fmt::print(stderr, "{}: {}\n", name, error.what())
                            : fmt::print(stderr, "{}: not enough memory; {}\n", name, memory_hint);
    }
    catch (const std::exception& error)
    {
        fmt::print(stderr, "{}: {}\n", name, printable_line(error.what()));
    }
    return kExitFailed;
}

} // namespace tactus
