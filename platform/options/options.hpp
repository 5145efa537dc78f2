// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/controller/run_hooks.hpp"

#include <functional>
#include <string>
#include <variant>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::hrtc
{

/// Command line of a program that runs the loop: its differences from that of hrtc.
struct CommandForm
{
    std::string name{"hrtc"};
    std::string description{
        "Haptic real-time controller: computes the contact of tools with models from servers or "
        "files, every period, exactly or with a proven bound."};
    bool records{true}; ///< True if the command takes --record, --replay, --trace and --histograms.
    double duration_s{10.0};
    /// Declares the command's own options; may be empty.
    std::function<void(CommandLine&)> declare;
    std::string footer; ///< End of --help.
    /// Names of the program's other commands, for messages.
    std::string commands;
    FileReaders readers; ///< Value of Options::readers.
};

/// True if a report of this name is a page: the name ends in .html.
[[nodiscard]] bool is_page_name(const std::string& path);

/// Parses the command line. Returns the exit code instead if the program should end: after --help,
/// --version or wrong usage. Wrong usage gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(int argc, char** argv,
                                                       const CommandForm& form);

/// Hooks of hrtc: a signal ends a session, and the progress appears on stderr.
[[nodiscard]] RunHooks program_hooks();

} // namespace tactus::hrtc
