// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>

namespace tactus::bench
{

/// Cuts each face into four at its edges' midpoints; faces that share an edge share its midpoint.
[[nodiscard]] TriangleMesh subdivided(const TriangleMesh& mesh);

/// Moves each vertex along its normal (mean of its faces', weighted by area) by a uniform share of
/// -`share` .. +`share` of the mean length of the edges that its faces have at it.
[[nodiscard]] TriangleMesh with_normal_noise(const TriangleMesh& mesh, double share,
                                             std::uint64_t seed);

} // namespace tactus::bench
