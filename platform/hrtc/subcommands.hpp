// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "transport/log.hpp"

#include <span>
#include <string>
#include <vector>

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

/// Runs hrtc --replay: repeats a recording's frames without device, network or timer. One line
/// tells if all frames agree, on stdout if they do, else through `log`. `kernels`: kernels of the
/// queries; null: the best of this processor. If all frames agree, the files `exports` are written;
/// their names must satisfy is_export_name(). Returns the exit code: done; criterion not met if a
/// frame differs; failed if the recording is refused or an export can't be written.
[[nodiscard]] int replay_file(const std::string& path, const Kernels* kernels,
                              const std::vector<std::string>& exports, const Log& log);

} // namespace tactus::hrtc
