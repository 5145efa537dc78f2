// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/closest_points.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace tactus
{

/// Nearest points of many pairs of triangles that are apart, of meshes whose faces have corners and
/// edges in common: up to 36 pairs of faces are as near as the two corners that all of them have.
///
/// Where a pair has the two features that were the nearest of another pair, and its other corners
/// are behind the planes through these features across the way between them, nothing else of it is
/// as near: the points are known. Only features are kept that have one such pair of points: a
/// corner and anything, or two edges that are not parallel. Haptic thread; good for triangles of
/// one frame. 2 KiB.
class SharedFeatures // NOLINT(cppcoreguidelines-pro-type-member-init): keys come with the known.
{
public:
    /// closest_points(first, second, false). Some 0.1 us where it is known, else as long as
    /// measuring takes.
    [[nodiscard]] ClosestPoints closest_points(const Triangle& first,
                                               const Triangle& second) noexcept TACTUS_NONBLOCKING;

private:
    /// A corner, the two of an edge, or all three for the inside.
    using Corners = StaticVector<Vec3, 3>;
    struct Known
    {
        Corners first;
        Corners second;
        ClosestPoints closest;
    };
    static constexpr std::uint32_t kKnown = 6;

    [[nodiscard]] std::optional<ClosestPoints>
    find(const Triangle& first, const Triangle& second) const noexcept TACTUS_NONBLOCKING;
    void keep(const Known& known) noexcept TACTUS_NONBLOCKING;

    StaticVector<Known, kKnown> known_;
    std::array<double, kKnown> first_keys_;  ///< Of each the first coordinate of a corner,
    std::array<double, kKnown> second_keys_; ///< to tell most others by.
    std::uint32_t oldest_{0};                ///< Its place there: the next that is forgotten.
};

} // namespace tactus
