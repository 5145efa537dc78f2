// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <array>

namespace tactus::test
{

using LongPoint = std::array<long double, 3>;

[[nodiscard]] inline LongPoint to_long(const Vec3& v)
{
    return {static_cast<long double>(v.x()), static_cast<long double>(v.y()),
            static_cast<long double>(v.z())};
}

/// Distance of a point to a triangle in extended precision, by the barycentric coordinates of the
/// foot point. Never too small; on needles of 24-bit corners up to 1e-3 quanta too large, on the
/// 16-bit meshes of these tests good to 1e-9. Shares no code with the kernel.
[[nodiscard]] long double oracle_distance(const LongPoint& point,
                                          const std::array<LongPoint, 3>& triangle);

/// The same by searching the triangle as a bundle of segments parallel to one side, over which the
/// distance is convex: no normal, no division by an area, so needles are as good as any. Slow.
[[nodiscard]] long double searched_distance(const LongPoint& point,
                                            const std::array<LongPoint, 3>& triangle);

} // namespace tactus::test
