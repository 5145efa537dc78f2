// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Generated meshes for tests, benches and the demo; the same bits on every machine (own sine, no
/// libm beyond sqrt). In metres, faces counter-clockwise seen from outside, vertices shared: all
/// are closed but the terrain.
enum class Shape
{
    sphere,       ///< Radius 50 mm, a subdivided icosahedron.
    bumpy_sphere, ///< The same, projected onto f = 0, see bumpy_radius_m().
    torus,        ///< Radii 50 and 20 mm round the z axis.
    terrain,      ///< A height field of 100 x 100 mm over z = 0, up along z, with a border.
    gear,         ///< Eight teeth, 50 mm outer radius, 20 mm thick, a bore; sharp edges.
    peg,          ///< A pin of 10 mm radius, 60 mm long along z, its edges broken by 1 mm.
    socket,       ///< A block of 30 mm radius with a blind hole of 10.2 mm, 40 mm deep from above.
    plate,        ///< 100 x 100 x 10 mm over z = 0, both sides cut into squares.
};

inline constexpr std::uint32_t kMinShapeFaces = 100;
inline constexpr std::uint32_t kMaxShapeFaces = 16'000'000;

/// The names as a user writes them: sphere, bumpy-sphere, torus, terrain, gear, peg, socket,
/// plate.
[[nodiscard]] std::vector<std::string_view> shape_names();
/// None for other names.
[[nodiscard]] std::optional<Shape> parse_shape(std::string_view name);

/// The shape with the face count nearest to `faces` that it can have at a sensible aspect ratio:
/// 20 n^2 for the spheres; within 2 % for the others from 10,000 faces on (a gear has at least
/// 256). Refused outside kMinShapeFaces .. kMaxShapeFaces.
[[nodiscard]] Result<TriangleMesh, Refusal> make_shape(Shape shape, std::uint32_t faces);

/// Where the bumpy sphere's surface f(x) = |x| - R (1 + a sin(m u) sin(m v) sin(m w)) = 0 with
/// (u, v, w) = x / |x| lies along a unit direction: R = 50 mm, a = 0.02, m = 8.
[[nodiscard]] double bumpy_radius_m(double u, double v, double w);

/// A sphere of 50 mm with poles of valence `segments`; 2 x segments x (rings - 1) faces. Few rings
/// and many segments make needles. At least 2 rings and 3 segments, at most kMaxShapeFaces faces;
/// others are refused, as below.
[[nodiscard]] Result<TriangleMesh, Refusal> make_uv_sphere(std::uint32_t rings,
                                                           std::uint32_t segments);

/// A closed plate of 100 x 100 mm, both sides cut into cells x cells squares. 1 .. 1000 cells, 1e-6
/// to 0.1 m thick.
[[nodiscard]] Result<TriangleMesh, Refusal> make_thin_plate(std::uint32_t cells,
                                                            double thickness_m);

/// Loose triangles of up to 5 mm in a cube of 100 mm, each with three vertices of its own.
/// 1 .. kMaxShapeFaces; the same seed gives the same mesh.
[[nodiscard]] Result<TriangleMesh, Refusal> make_triangle_soup(std::uint32_t triangles,
                                                               std::uint64_t seed);

} // namespace tactus
