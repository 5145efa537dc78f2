// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/keys/site.hpp"

#include <variant>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::keys
{

/// Reads the command line and the option file. Returns the exit code if the program should end:
/// after --help, --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Site, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::keys
