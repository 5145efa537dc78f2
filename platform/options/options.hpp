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

/// A command that runs the loop, and how its line differs from that of hrtc itself.
struct CommandForm
{
    std::string name{"hrtc"};
    std::string description{"Haptic real-time controller: touches models that a host publishes, "
                            "every period, exactly or with a proven bound."};
    bool records{true}; ///< Takes --record, --replay, --trace and --histograms, too.
    double duration_s{10.0};
    std::function<void(CommandLine&)> declare; ///< Its own options; none when empty.
    std::string footer;                        ///< The end of --help.
    std::string commands;                      ///< The program's other commands, for messages.
    FileReaders readers;                       ///< Lent to the options.
};

/// Whether a report that is to have this name is a page: it ends in .html.
[[nodiscard]] bool is_page_name(const std::string& path);

/// Reads the command line. Returns the exit code instead when the program should leave: after
/// --help, --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(int argc, char** argv,
                                                       const CommandForm& form);

} // namespace tactus::hrtc
