// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"

#include <span>
#include <string>

namespace tactus::hrtc
{

/// Subcommand of hrtc, chosen by the first argument of hrtc. It parses the further arguments.
struct Subcommand
{
    const char* name;
    const char* summary;     ///< One line for --help.
    int (*run)(int, char**); ///< Runs it; argv[0] is the name. Returns the exit code.
};

[[nodiscard]] std::span<const Subcommand> subcommands() noexcept;

/// Subcommand that the first argument names, with or without two dashes; null if there is none.
[[nodiscard]] const Subcommand* find_subcommand(int argc, char** argv) noexcept;

/// Names of the subcommands, separated by commas.
[[nodiscard]] std::string subcommand_names();

/// Paragraph on the subcommands for the end of --help.
[[nodiscard]] std::string describe_subcommands();

/// Form of hrtc's command line without a subcommand.
[[nodiscard]] CommandForm program_form();

} // namespace tactus::hrtc
