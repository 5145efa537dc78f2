// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Readers, one for each format. Refusals state the place in the file; read_mesh_file() adds the
/// file's name and checks the properties common to all formats.
namespace tactus::detail
{

/// Converts polygons to triangles. A polygon with n corners becomes n - 2 consecutive faces, in the
/// order of the input. Formats may use vertices before they define their positions, so polygons are
/// fans at first; finish() cuts those again that a fan does not fit.
class PolygonSink
{
public:
    explicit PolygonSink(TriangleMesh& mesh) : mesh_(mesh) {}

    /// Adds a polygon. If there are more than three corners, adjacent equal corners count once.
    void add(std::span<const std::uint32_t> corners);

    /// Cuts the polygons; every vertex must have its position, and the corners must be vertices.
    /// Adds a note for polygons that have too few corners or cross themselves.
    void finish(std::vector<std::string>& notes);

private:
    struct Fan
    {
        std::size_t first_face;
        std::uint32_t corners;
    };

    TriangleMesh& mesh_;
    std::vector<std::uint32_t> corners_;
    std::vector<Fan> fans_;    ///< Polygons with more than three corners.
    std::uint64_t smaller_{0}; ///< Number of polygons with fewer than three corners.
};

[[nodiscard]] Result<MeshFile, Refusal> read_ply(std::string_view bytes);
[[nodiscard]] Result<MeshFile, Refusal> read_obj(std::string_view text);
[[nodiscard]] Result<MeshFile, Refusal> read_stl(std::string_view bytes);
[[nodiscard]] Result<MeshFile, Refusal> read_off(std::string_view text);

/// Adds a note if a text format does not end in a line end: its last number may have lost digits.
void note_missing_line_end(std::string_view text, std::vector<std::string>& notes);

/// A triangle of corners of a polygon, as indices of these corners in the polygon.
using CornerTriangle = std::array<std::uint32_t, 3>;

/// Cuts a polygon with n >= 4 corners in space into n - 2 triangles of its orientation in its
/// best-fit plane. If a fan from the first corner covers the polygon, it is used; otherwise ears
/// are cut. Collinear and coincident corners and bridges to holes are handled: parts without area
/// become triangles without area, so that each corner stays in the mesh. None if the polygon
/// crosses itself or has no area. Takes on the order of n^2 steps.
[[nodiscard]] std::optional<std::vector<CornerTriangle>>
cut_polygon(std::span<const std::array<double, 3>> corners);

/// Name of standard input on a command line.
inline constexpr const char* kStandardInput = "-";

/// Reads a file like read_file(), or a pipe, a device or standard input (by its name) to its end.
[[nodiscard]] Result<std::string, Refusal> read_input(const std::filesystem::path& path);

/// Name of an input for messages.
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

} // namespace tactus::detail
