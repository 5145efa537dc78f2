// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"

#include <functional>
#include <string>
#include <variant>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::hrtc
{

/// Command that runs the loop, with the differences of its command line from that of hrtc.
struct CommandForm
{
    std::string name{"hrtc"};
    std::string description{"Haptic real-time controller: touches models that a host publishes, "
                            "every period, exactly or with a proven bound."};
    bool records{true}; ///< Also takes --record, --replay, --trace and --histograms.
    double duration_s{10.0};
    std::function<void(CommandLine&)> declare; ///< Declares the command's own options; may be
                                               ///< empty.
    std::string footer;                        ///< End of --help.
    std::string commands;                      ///< Names of the program's other commands, for
                                               ///< messages.
    FileReaders readers;                       ///< Readers for the options.
};

/// True if a report of this name is a page: the name ends in .html.
[[nodiscard]] bool is_page_name(const std::string& path);

/// Parses the command line. Returns the exit code instead if the program should end: after --help,
/// --version or wrong usage. Wrong usage gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(int argc, char** argv,
                                                       const CommandForm& form);

} // namespace tactus::hrtc
