// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::detail
{

/// A triangle of corners of a polygon, as indices of these corners in the polygon.
using CornerTriangle = std::array<std::uint32_t, 3>;

/// Cuts a polygon with n >= 4 corners in space into n - 2 triangles of its orientation in its
/// best-fit plane. If a fan from the first corner covers the polygon, it is used; otherwise ears
/// are cut. Collinear and coincident corners and bridges to holes are handled: parts without area
/// become triangles without area, so that each corner stays in the mesh. None if the polygon
/// crosses itself or has no area. Takes on the order of n^2 steps.
[[nodiscard]] std::optional<std::vector<CornerTriangle>>
cut_polygon(std::span<const std::array<double, 3>> corners);

} // namespace tactus::detail
