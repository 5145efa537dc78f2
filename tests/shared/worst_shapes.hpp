// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "tests/shared/test_model.hpp"

#include <cstddef>
#include <cstdint>

/// Meshes that are hard on the frame, for tests only. About 0.1 m across.
namespace tactus::test
{

/// Sphere of about 2,000 faces on which every 40th vertex stands out by twice the radius.
[[nodiscard]] TriangleMesh make_spiky_sphere();

/// Three open square sheets of cells x cells squares, one above the other, 1e-4 of the diagonal
/// apart.
[[nodiscard]] TriangleMesh make_close_sheets(std::uint32_t cells);

/// Patch of 1 mm in cells x cells squares, in the middle of a square of 100 mm of a few huge faces
/// and a fan of long needles.
[[nodiscard]] TriangleMesh make_patch_in_huge_faces(std::uint32_t cells);

/// Sphere of about 2,000 faces with fins on some of its edges, so that three faces meet there, and
/// with duplicate, degenerate and flat faces.
[[nodiscard]] TriangleMesh make_broken_sphere();

/// Separate spheres of 80 faces on a cubic lattice of per_side^3.
[[nodiscard]] TriangleMesh make_loose_spheres(std::uint32_t per_side);

/// Cube without one of its eight octants, of cells x cells squares a side of an octant: sharp and
/// concave edges and corners, flat faces.
[[nodiscard]] TriangleMesh make_notched_cube(std::uint32_t cells);

/// Models of these and other worst shapes for a frame: needles, poles, spikes, thin and close
/// sheets, huge faces beside tiny ones, borders, and loose pieces.
[[nodiscard]] std::size_t worst_model_count();
[[nodiscard]] const TestModel& worst_model(std::size_t index);

/// All generated models: the small_model()s and the worst_model()s.
[[nodiscard]] std::size_t generated_model_count();
[[nodiscard]] const TestModel& generated_model(std::size_t index);

} // namespace tactus::test
