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

/// Directions that separate a convex body from triangles. Most triangles nearby are separated by
/// the same directions: a test takes a product for each corner, a distance takes up to
/// kGjkIterations support points. The bounds are right for any directions.
///
/// Lengths and frame are those of the placed core. For one query. Haptic thread. 0.7 KiB.
class Separations // NOLINT(cppcoreguidelines-pro-type-member-init): see() fills the heights.
{
public:
    /// `core` is a convex body and outlives this object.
    explicit Separations(const PlacedCore& core) noexcept TACTUS_NONBLOCKING;

    /// Lower bound on the distance between the body and all triangles of the corners in `used`, one
    /// bit each; below zero if nothing is known. `seen` are the same corners. Directions are tried
    /// until one gives more than `enough`. The corners must stay while bound() is called. 20 ns for
    /// each direction.
    [[nodiscard]] double see(const std::array<CornerRow, 3>& corners, std::uint32_t used,
                             const CornersAtCore& seen, double enough) noexcept TACTUS_NONBLOCKING;

    /// The same for one triangle of the last corners of see(), if that found less than enough; uses
    /// the directions known by now. 2 ns for each.
    [[nodiscard]] double
    bound(const std::array<std::uint8_t, 3>& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Adds a direction of length 1 from the body to one of these triangles; a full list drops the
    /// oldest. 50 ns.
    void add(const Vec3& direction) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::size_t kDirections = 4;

    struct Direction
    {
        Vec3 way{0.0, 0.0, 0.0};
        double reach{0.0}; ///< Support of the body along it, from the centre.
    };

    void measure(std::size_t direction) noexcept;

    const PlacedCore& core_;
    ConvexBody body_;
    const std::array<CornerRow, 3>* corners_{nullptr};
    std::array<Direction, kDirections> directions_;
    std::size_t count_{0};
    std::size_t measured_{0}; ///< Directions with known heights of the corners.
    std::size_t oldest_{0};
    std::array<CornersAtCore::Row, kDirections> heights_; ///< Heights beyond the body's reach.
    double rounding_{0.0};                                ///< Rounding of these heights.
};

} // namespace tactus
