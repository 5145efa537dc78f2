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

/// A triangle of corners of a polygon, by their places in it.
using CornerTriangle = std::array<std::uint32_t, 3>;

/// Cuts a polygon with n >= 4 corners in space into n - 2 triangles that turn as it does, in the
/// plane that it lies in best. A fan from the first corner is kept where it covers the polygon;
/// else ears are cut. Corners on one line, in one place and bridges to holes are handled: what has
/// no area becomes triangles without area, so that each corner stays in the mesh. None when the
/// polygon crosses itself or has no area. Takes some n^2 steps.
[[nodiscard]] std::optional<std::vector<CornerTriangle>>
cut_polygon(std::span<const std::array<double, 3>> corners);

} // namespace tactus::detail
