// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/tool_load.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::hrtc
{

struct Options;

/// The shape of a tool, as --tool says it.
struct ToolChoice
{
    std::string words;      ///< As they were given.
    double radius_m{0.0};   ///< Added all round.
    ToolCore core{};        ///< Of a hull or mesh after take_tool_files().
    std::string hull_file;  ///< Not empty: a mesh file, whose vertices' hull it is.
    std::string mesh_model; ///< Not empty: NAME[@HASH] of the model that it is, or a path.
    std::shared_ptr<const std::vector<Vec3>> hull_vertices; ///< The core's; in metres.
};

/// "point", "sphere:R", "capsule:R,L", "box:X,Y,Z[,R]", "hull:FILE[,R]" or "mesh:NAME[@HASH][,R]",
/// in metres: R is the radius, L the length of the axis, which is the tool's z, without its caps,
/// X, Y and Z are whole edges before R.
[[nodiscard]] Result<ToolChoice, Refusal> parse_tool(std::string_view text);

/// KG[,X,Y,Z]: 0 to 5 kg, and its centre in metres, within 1 m; down is -z.
[[nodiscard]] Result<ToolLoad, Refusal> parse_tool_mass(std::string_view text);

/// The sphere of tools that nothing is said of: 1 % of a diagonal, within what parse_tool() takes.
[[nodiscard]] ToolChoice default_tool(double diagonal_m);

/// Reads the files of hulls, and adds what is a mesh to the options' models. After the models that
/// objects show are known. Returns why a tool can't be had.
[[nodiscard]] std::optional<Refusal> take_tool_files(Options& options);

/// A sphere of so many metres round the tool's origin holds the tool. `mesh`: of a tool that is
/// one.
[[nodiscard]] double reach_m(const ToolChoice& tool, const ModelHeader* mesh);

/// How far from a surface a simulated operator holds the tool's origin to touch it: a sphere's
/// radius, half of what others reach, however they are turned, and that of default_tool() for a
/// point; no more than the diagonal of the model that it touches.
[[nodiscard]] double hand_radius_m(const ToolChoice& tool, const ModelHeader* mesh,
                                   double diagonal_m);

} // namespace tactus::hrtc
