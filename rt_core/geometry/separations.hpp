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

/// Directions along which a convex body was found to be apart from triangles. Triangles nearby are
/// mostly apart along the same ones: that takes a product for each corner, where a distance takes
/// kGjkIterations farthest points at most. Whatever directions are known, the bounds are right.
///
/// Lengths and frame are those of the placed core. For one query. Haptic thread. 0.7 KiB.
class Separations // NOLINT(cppcoreguidelines-pro-type-member-init): see() fills the heights.
{
public:
    /// `core` is a convex body and outlives this.
    explicit Separations(const PlacedCore& core) noexcept TACTUS_NONBLOCKING;

    /// The body and all triangles of the corners in `used`, a bit each, are at least this far
    /// apart; less than zero where nothing is known. `seen` are the same corners. Directions are
    /// tried until one shows more than `enough`. The corners are to stay while more is asked of
    /// them. 20 ns for each direction.
    [[nodiscard]] double see(const std::array<CornerRow, 3>& corners, std::uint32_t used,
                             const CornersAtCore& seen, double enough) noexcept TACTUS_NONBLOCKING;

    /// The same of one triangle of the corners that see() was given last, where it did not find
    /// enough; from the directions that are known by now. 2 ns for each.
    [[nodiscard]] double
    bound(const std::array<std::uint8_t, 3>& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Adds a direction from the body to one of these triangles, of length 1; where there is no
    /// room the one that was added first goes. 50 ns.
    void add(const Vec3& direction) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::size_t kDirections = 4;

    struct Direction
    {
        Vec3 way{0.0, 0.0, 0.0};
        double reach{0.0}; ///< The body's, along it from the centre.
    };

    void measure(std::size_t direction) noexcept;

    const PlacedCore& core_;
    ConvexBody body_;
    const std::array<CornerRow, 3>* corners_{nullptr};
    std::array<Direction, kDirections> directions_;
    std::size_t count_{0};
    std::size_t measured_{0}; ///< For so many the corners' heights are known.
    std::size_t oldest_{0};
    std::array<CornersAtCore::Row, kDirections> heights_; ///< Beyond the body's reach.
    double rounding_{0.0};                                ///< Of these.
};

} // namespace tactus
