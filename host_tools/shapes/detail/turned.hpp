// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <span>

namespace tactus::detail
{

/// Corner of an outline that is rotated around the z axis.
struct OutlinePoint
{
    double from_axis_m{0.0};
    double z_m{0.0};
};

/// Solid of revolution of an outline. The outline's first and last corners are on the axis, the
/// first below the last; the outside lies on the right. Between these corners it gets `rings`
/// circles of `segments` vertices each, including one circle at each corner: 2 x segments x rings
/// faces. `rings` is at least the number of corners between the ends, `segments` at least 3.
[[nodiscard]] TriangleMesh make_turned(std::span<const OutlinePoint> outline,
                                       std::uint32_t segments, std::uint32_t rings);

} // namespace tactus::detail
