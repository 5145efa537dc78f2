// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"

#include <span>
#include <string>

namespace tactus::hrtc
{

/// What hrtc does when its first argument is this word. The rest of the line is the subcommand's.
struct Subcommand
{
    const char* name;
    const char* summary;     ///< One line for --help.
    int (*run)(int, char**); ///< argv[0] is the name; returns the exit code.
};

[[nodiscard]] std::span<const Subcommand> subcommands() noexcept;

/// The one that the first argument names, with or without two dashes; null when it names none.
[[nodiscard]] const Subcommand* find_subcommand(int argc, char** argv) noexcept;

/// With commas between.
[[nodiscard]] std::string subcommand_names();

/// A paragraph for the end of --help.
[[nodiscard]] std::string describe_subcommands();

/// The form of hrtc's own command line.
[[nodiscard]] CommandForm program_form();

} // namespace tactus::hrtc
