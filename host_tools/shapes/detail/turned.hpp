// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <span>

namespace tactus::detail
{

/// A corner of an outline that is turned round the z axis.
struct OutlinePoint
{
    double from_axis_m{0.0};
    double z_m{0.0};
};

/// What a lathe makes: the outline's first and last corners are on the axis, the first one below;
/// what is outside lies on its right. It is cut so that `rings` circles of `segments` vertices each
/// lie between them, one at each corner: 2 x segments x rings faces. As many rings as the outline
/// has corners between its ends, and 3 segments, at least.
[[nodiscard]] TriangleMesh make_turned(std::span<const OutlinePoint> outline,
                                       std::uint32_t segments, std::uint32_t rings);

} // namespace tactus::detail
