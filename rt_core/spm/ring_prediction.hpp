// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/error_code.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// A vertex on the integer grid, in quanta.
using GridPosition = std::array<std::int32_t, 3>;

/// Predicts a new vertex from the closed ring of vertices round it: at their mean, and in the
/// ring's plane once two coordinates are known. Whole numbers only, so that encoder and decoder
/// agree everywhere.
class RingPrediction
{
public:
    /// 3 to 8 vertices in order, coordinates within 0 .. 2^24.
    explicit RingPrediction(std::span<const GridPosition> ring) noexcept;

    /// v minus its prediction: two coordinates, then the one most along the plane's normal,
    /// positive outward.
    [[nodiscard]] std::array<std::int32_t, 3> residual_of(const GridPosition& v) const noexcept;
    [[nodiscard]] GridPosition
    position_of(const std::array<std::int32_t, 3>& residual) const noexcept;

private:
    [[nodiscard]] std::int64_t height_at(std::int64_t first, std::int64_t second) const noexcept;

    GridPosition mean_{};
    std::array<std::int64_t, 3> normal_{};
    std::size_t axis_{2}; ///< Axis of the normal's largest component.
    std::int32_t outward_{1};
};

/// Code of a radius round v that holds a star with this ring and largest error.
[[nodiscard]] ErrorCode star_reach(const GridPosition& v, std::span<const GridPosition> ring,
                                   ErrorCode largest_error) noexcept;

} // namespace tactus
