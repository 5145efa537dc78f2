// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/zone.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <array>
#include <vector>

namespace tactus
{

using Point = std::array<double, 3>;
/// Face by the positions of its corners, the least first: independent of ids.
using PlainFace = std::array<Point, 3>;

[[nodiscard]] inline Vec3 to_vec(const Point& p)
{
    return {p[0], p[1], p[2]};
}

[[nodiscard]] std::vector<PlainFace> faces_of(const TriangleMesh& mesh);

/// Faces of the source on its grid, in the source's frame.
[[nodiscard]] std::vector<PlainFace> source_faces(const EncodedModel& model);

/// Greatest distance of points of the source, corners and others, to the mesh, by brute force.
[[nodiscard]] long double sampled_distance(const EncodedModel& model, const TriangleMesh& mesh,
                                           int samples, test::Random& random);

/// True if some point of a fine raster on the face is in the zone.
[[nodiscard]] bool reaches_into(const Zone& zone, const PlainFace& face);

} // namespace tactus
