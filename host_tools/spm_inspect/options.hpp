// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_inspect/extraction.hpp"

#include <string>
#include <variant>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::spm_inspect
{

/// Options of the command line; checked, in SI units.
struct Options
{
    std::string file;
    bool json{false};
    bool regions{false};
    bool records{false};
    std::string points; ///< File of points for distances; empty if there is none.
    Extractor extractor;
};

/// Reads the command line. Returns the exit code instead if the program should leave: after --help,
/// --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::spm_inspect
