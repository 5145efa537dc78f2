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
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{
struct DeviceLimits;
} // namespace tactus

namespace tactus::hrtc
{

struct Options;
struct ToolOptions;

/// Shape of a tool, as given by --tool.
struct ToolChoice
{
    std::string words;      ///< Text as given.
    double radius_m{0.0};   ///< Radius added around the core.
    ToolCore core{};        ///< Core; a hull's or mesh's is set by take_tool_files().
    std::string hull_file;  ///< Mesh file whose vertices span the hull, if not empty.
    std::string mesh_model; ///< Model of a mesh tool, if not empty: NAME[@HASH] or a path.
    std::shared_ptr<const std::vector<Vec3>> hull_vertices; ///< Vertices of the hull, in metres.
};

/// Parses "point", "sphere:R", "capsule:R,L", "box:X,Y,Z[,R]", "hull:FILE[,R]" or
/// "mesh:NAME[@HASH][,R]", in metres. R is the radius. L is the length of the axis along the tool's
/// z, without the caps. X, Y and Z are full edge lengths, without R.
[[nodiscard]] Result<ToolChoice, Refusal> parse_tool(std::string_view text);

/// Parses KG[,X,Y,Z], the payload: 0 to 5 kg, and its centre of mass in the tool's frame, in
/// metres, within 1 m of the origin. Gravity points along -z.
[[nodiscard]] Result<ToolLoad, Refusal> parse_tool_mass(std::string_view text);

/// Sets the core of a hull's tool to the convex hull of these corners, each kept once. `source`
/// begins the refusal of too many corners, or of one too far from the tool's origin.
[[nodiscard]] std::optional<Refusal> set_hull(ToolChoice& tool, std::span<const Vec3> corners,
                                              const std::string& source);

/// True for a point or a sphere, which alone feel shaded facets.
[[nodiscard]] bool is_round(const ToolOptions& tool);

/// Sphere for tools without --tool: its radius is 1 % of `diagonal_m`, clamped to the range of
/// parse_tool().
[[nodiscard]] ToolChoice default_tool(double diagonal_m);

/// Reads the files of hulls, and adds the models of mesh tools to `options`. Call it once the
/// objects' models are known. Returns the refusal of the first tool that can't be made.
[[nodiscard]] std::optional<Refusal> take_tool_files(Options& options);

/// Radius in metres of a sphere round the tool's origin that holds the tool. `mesh` is the header
/// of a mesh tool's model, null otherwise.
[[nodiscard]] double reach_m(const ToolChoice& tool, const ModelHeader* mesh);

/// Distance of the tool's origin from a surface that a simulated operator touches: the radius of a
/// sphere, half of reach_m() for other shapes in any orientation, and for a point the radius of
/// default_tool(). At most `diagonal_m`, the diagonal of the touched model.
[[nodiscard]] double operator_radius_m(const ToolChoice& tool, const ModelHeader* mesh,
                                       double diagonal_m);

struct ToolOptions;

/// Each parses the value of one option of a tool and sets it: of --tool, --tool-mass, --fixture,
/// --device, --device-limits, --device-frame and --motion, in this order. Returns the fault, and
/// then changes nothing; empty if there is none. The device comes before its limits, frame and
/// motion.
[[nodiscard]] std::string set_tool_shape(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_mass(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_fixture(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_device(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_limits(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_frame(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_edit(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_motion(const std::string& text, ToolOptions& tool);

/// Sets device limits from `KEY=VALUE` pairs, separated by commas. The keys are the member names of
/// DeviceLimits, in SI units; those of RotationLimits begin with `rotation.`. Returns the fault,
/// and then changes nothing; empty if there is none.
[[nodiscard]] std::string set_device_limits(std::string_view text, DeviceLimits& limits);

} // namespace tactus::hrtc
