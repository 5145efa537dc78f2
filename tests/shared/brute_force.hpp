// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <array>
#include <vector>

namespace tactus::test
{

using Face = std::array<Vec3f, 3>;

/// Distance from a point to a triangle in long double, by DistanceOracle, which shares no code with
/// the tested kernels. Triangles without an area count as their edges.
[[nodiscard]] long double brute_distance(const Vec3& point, const Face& face);

/// Distance from a point to a whole mesh, face by face.
[[nodiscard]] long double brute_distance(const Vec3& point, const std::vector<Face>& faces);

} // namespace tactus::test
