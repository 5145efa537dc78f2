// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
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

/// Everything that the command line says; checked, in SI.
struct Options
{
    std::vector<std::string> files; ///< Models, or one scene.
    bool has_scene{false};
    std::vector<std::string> names; ///< Of the models, in the order of the files; none of a scene.
    std::string scene;              ///< Empty: no name.
    std::uint32_t domain{0};
    std::optional<double> seconds;
    std::string poses_path; ///< Empty: no file moves anything.
    bool poses_loop{false};
    std::optional<double> poses_rate_hz;
    bool watch{false};
    std::optional<std::uint32_t> metrics_port;
};

/// The names that models of these files have: the given ones, and of further files the stems. A
/// line when one is missing, wrong or there twice.
[[nodiscard]] Result<std::vector<std::string>, Refusal>
choose_names(std::span<const std::string> files, std::span<const std::string> given);

/// Reads the command line. Returns the exit code instead when the program should leave: after
/// --help, --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::spm_publish
