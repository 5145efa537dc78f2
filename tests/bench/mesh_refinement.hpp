// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>

namespace tactus::bench
{

/// Splits each face into four at its edge midpoints; faces with a common edge share its midpoint.
[[nodiscard]] TriangleMesh subdivided(const TriangleMesh& mesh);

/// Moves each vertex along its normal (area-weighted mean of its faces) by a uniform share in
/// -`share` .. +`share` of the mean length of its faces' edges there.
[[nodiscard]] TriangleMesh with_normal_noise(const TriangleMesh& mesh, double share,
                                             std::uint64_t seed);

} // namespace tactus::bench
