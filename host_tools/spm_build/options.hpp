// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/build/build_model.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/spm_build/placing.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::spm_build
{

/// Options of the command line; checked, in SI units.
struct Options
{
    std::string input;
    std::string output;
    std::optional<MeshFormat> format; ///< Format of the input. [default: from its name]
    std::string shape;
    std::uint32_t shape_faces{0};
    std::string unit{"m"};
    ModelOptions model;
    Placing placing;
    bool json{false};

    /// Name of the model's source in messages.
    [[nodiscard]] std::string source() const { return shape.empty() ? input : "--shape " + shape; }
    /// True if `input` is a scene, and `output` the folder for its models.
    [[nodiscard]] bool is_of_scene() const;
};

/// Reads the command line. Returns the exit code instead if the program should leave: after --help,
/// --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::spm_build
