// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus
{

/// Directions that separate a convex body from triangles, for cheap lower bounds on their
/// distances. Most triangles nearby are separated by the same directions. A test takes one product
/// for each corner, a measurement up to kGjkIterations support points. The bounds hold for any
/// directions.
///
/// Lengths and frame are those of the placed core. Valid for one query. Haptic thread. 0.7 KiB.
class Separations // NOLINT(cppcoreguidelines-pro-type-member-init): bound_all() fills the heights.
{
public:
    /// `core` must be a convex body and outlive this object.
    explicit Separations(const PlacedCore& core) noexcept TACTUS_NONBLOCKING;

    /// Lower bound on the distance of the body from all triangles of the corners in `used`, one bit
    /// each; below zero if nothing is known. `seen` are the same corners in the frame of the core's
    /// box. Directions are tried until one gives more than `enough`. `corners` must stay valid for
    /// bound(). 20 ns for each direction.
    [[nodiscard]] double bound_all(const std::array<CornerRow, 3>& corners, std::uint32_t used,
                                   const CornersAtCore& seen,
                                   double enough) noexcept TACTUS_NONBLOCKING;

    /// Lower bound on the distance of one triangle of the last bound_all(), which must have found
    /// less than enough. Uses the directions known by now, 2 ns for each.
    [[nodiscard]] double
    bound(const std::array<std::uint8_t, 3>& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Adds a direction of length 1 from the body to a triangle; a full list drops the oldest. 50
    /// ns.
    void add(const Vec3& direction) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::size_t kDirections = 4;

    struct Direction
    {
        Vec3 way{0.0, 0.0, 0.0};
        double reach{0.0}; ///< Reach of the body along `way`, from its centre.
    };

    void measure(std::size_t direction) noexcept;

    const PlacedCore& core_;
    ConvexBody body_;
    const std::array<CornerRow, 3>* corners_{nullptr};
    std::array<Direction, kDirections> directions_;
    std::size_t count_{0};
    /// Number of directions in which the heights of the corners are known.
    std::size_t measured_{0};
    std::size_t oldest_{0};
    /// Heights of the corners beyond the body's reach, for each direction.
    std::array<CornersAtCore::Row, kDirections> heights_;
    double rounding_{0.0}; ///< Bound on the rounding of these heights.
};

} // namespace tactus
