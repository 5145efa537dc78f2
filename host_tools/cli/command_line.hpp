// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace tactus
{

/// The exit codes of every program.
inline constexpr int kExitDone = 0;
inline constexpr int kExitCriterionNotMet = 1;
inline constexpr int kExitFailed = 2;
inline constexpr int kExitUsage = 3;

/// Parses a command line. Returns the code to leave with after --help or --version, and after wrong
/// usage, which gets one line on stderr; nothing when the program should go on.
[[nodiscard]] std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

/// Accepts numbers from `least` to `most`, both included, and no NaN.
[[nodiscard]] CLI::Validator number_between(double least, double most);

/// Says in one line on stderr, behind the program's name, why it fails; returns `code`. Control
/// characters of file names and the like are shown as '?'.
int fail(const CLI::App& app, const std::string& text, int code = kExitFailed);

} // namespace tactus
