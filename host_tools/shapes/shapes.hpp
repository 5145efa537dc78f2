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

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Generated meshes for tests, benchmarks and the demo; the same bits on every machine (own sine,
/// no libm beyond sqrt). Metres, faces counter-clockwise seen from outside, shared vertices; all
/// are closed except the terrain.
enum class Shape
{
    sphere,       ///< Subdivided icosahedron of radius 50 mm.
    bumpy_sphere, ///< Subdivided icosahedron on the surface of bumpy_radius_m().
    torus,        ///< Radii 50 and 20 mm around the z axis.
    terrain,      ///< Height field of 100 x 100 mm over z = 0, up along z, with a border.
    gear,         ///< Eight teeth, 50 mm outer radius, 20 mm thick, a bore; sharp edges.
    peg,          ///< Pin of 10 mm radius, 60 mm long along z, edges chamfered by 1 mm.
    socket,       ///< Block of 30 mm radius; blind hole from above: 10.2 mm radius, 40 mm deep.
    plate,        ///< 100 x 100 x 10 mm over z = 0, both sides cut into squares.
};

inline constexpr std::uint32_t kMinShapeFaces = 100;
inline constexpr std::uint32_t kMaxShapeFaces = 16'000'000;

/// Names of the shapes: sphere, bumpy-sphere, torus, terrain, gear, peg, socket, plate.
[[nodiscard]] std::vector<std::string_view> shape_names();
/// Shape of a name; none for other names.
[[nodiscard]] std::optional<Shape> parse_shape(std::string_view name);

/// Mesh of a shape with the face count nearest to `faces` at a reasonable aspect ratio: 20 n^2 for
/// the spheres; within 2 % for the others from 10,000 faces on (a gear has at least 256). Refused
/// outside kMinShapeFaces .. kMaxShapeFaces.
[[nodiscard]] Result<TriangleMesh, Refusal> make_shape(Shape shape, std::uint32_t faces);

/// Distance from the origin to the bumpy sphere's surface along a unit direction (u, v, w): the
/// zero of f(x) = |x| - R (1 + a sin(m u) sin(m v) sin(m w)), where R = 50 mm, a = 0.02, m = 8.
[[nodiscard]] double bumpy_radius_m(double u, double v, double w);

/// Sphere of 50 mm radius with poles of valence `segments`; 2 x segments x (rings - 1) faces. Few
/// rings and many segments give needles. Refused with fewer than 2 rings, fewer than 3 segments, or
/// more than kMaxShapeFaces faces.
[[nodiscard]] Result<TriangleMesh, Refusal> make_uv_sphere(std::uint32_t rings,
                                                           std::uint32_t segments);

/// Closed plate of 100 x 100 mm, both sides cut into cells x cells squares. Refused outside 1 ..
/// 1000 cells or 1e-6 .. 0.1 m of thickness.
[[nodiscard]] Result<TriangleMesh, Refusal> make_thin_plate(std::uint32_t cells,
                                                            double thickness_m);

/// Separate triangles of up to 5 mm in a cube of 100 mm, each with its own three vertices. The same
/// seed gives the same mesh. Refused outside 1 .. kMaxShapeFaces triangles.
[[nodiscard]] Result<TriangleMesh, Refusal> make_triangle_soup(std::uint32_t triangles,
                                                               std::uint64_t seed);

} // namespace tactus
