// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/surface_editor.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/edit_content.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

// The truth about edited surfaces, from triangles alone: it shares no code with the editor.
namespace tactus::test
{

using SoupFace = std::array<Vec3, 3>;
using Soup = std::vector<SoupFace>;

[[nodiscard]] Soup soup_of(const TriangleMesh& mesh);

/// Sum of the signed solid angles of all faces, over 4 pi: an integer off a closed surface.
[[nodiscard]] double winding_number(const Soup& soup, const Vec3& point);

[[nodiscard]] double distance_to(const Soup& soup, const Vec3& point);

[[nodiscard]] double volume_of(const Soup& soup);

/// Number of oriented edges by position that no opposite edge cancels.
[[nodiscard]] std::size_t open_edges(const TriangleMesh& mesh);

/// Model's surface as a controller keeps it: faces by id, changed by edits alone.
struct EditedFaces
{
    explicit EditedFaces(const DecodedModel& model, std::uint32_t room);

    /// Applies an edit by the rules of a frame; the text of the broken rule, or nothing.
    [[nodiscard]] std::string apply(const EditContent& edit);
    /// Faces in the model's frame, in a fixed order: each rotated to its least corner, sorted.
    [[nodiscard]] std::vector<std::array<Vec3f, 3>> sorted() const;

private:
    std::uint32_t source_ids_;
    std::uint32_t room_;
    std::array<std::uint32_t, 3> extent_;
    double quantum_m_;
    std::uint32_t revision_{0};
    std::map<std::uint32_t, std::array<Vec3f, 3>> faces_;
};

/// The editor's surface in the same order and frame.
[[nodiscard]] std::vector<std::array<Vec3f, 3>> sorted_faces(const SurfaceEditor& editor,
                                                             const Vec3& origin_m);

/// Axis-parallel cube of 100 mm round the origin, each side cut into cells x cells squares.
[[nodiscard]] TriangleMesh make_cube(std::uint32_t cells);
/// Closed plate of 100 x 100 x 20 mm round the origin with noise of 0.5 mm on its top.
[[nodiscard]] TriangleMesh make_noisy_plate(std::uint32_t cells, std::uint64_t seed);

} // namespace tactus::test
