// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/network_security.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::spm_publish
{

/// Options of the command line; checked, in SI units.
struct Options
{
    std::vector<std::string> files; ///< Models, or one scene.
    bool has_scene{false};
    /// Names of the models, in the order of the files; none for a scene.
    std::vector<std::string> names;
    std::string scene; ///< Name of the scene; empty: none.
    std::uint32_t domain{0};
    NetworkSecurity security;
    std::optional<double> seconds;
    std::string poses_path; ///< Pose file; empty: none.
    bool poses_loop{false};
    std::optional<double> poses_rate_hz;
    bool watch{false};
    std::optional<std::uint32_t> metrics_port;
    /// Slots of each model for faces that edits add; 0: no edits.
    std::uint32_t edit_room{0};
    bool has_edits{false};
    /// Controllers that may edit; empty: editors by the network's kind (main.cpp).
    std::vector<std::string> editors;
    std::string save_path; ///< File of the edited model; empty: none.
};

/// Names of the models in these files: the given ones, then the stems of further files. Refused if
/// one is missing, invalid or a duplicate.
[[nodiscard]] Result<std::vector<std::string>, Refusal>
choose_names(std::span<const std::string> files, std::span<const std::string> given);

/// Reads the command line. Returns the exit code instead if the program should leave: after --help,
/// --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::spm_publish
