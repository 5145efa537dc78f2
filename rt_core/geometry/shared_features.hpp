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

/// Cache of nearest points for many pairs of separate triangles from meshes, whose faces share
/// corners and edges: up to 36 pairs of faces have the same two nearest corners.
///
/// Two pairs of triangles have the same nearest points if both have the two nearest features, and
/// all other corners lie behind the planes through these features, across their connection. Only
/// features with a single pair of nearest points are kept: a corner and anything, or two edges that
/// are not parallel. Haptic thread; for triangles of one frame. 2 KiB.
class SharedFeatures // NOLINT(cppcoreguidelines-pro-type-member-init): keys come with the known.
{
public:
    /// Returns closest_points(first, second, false). About 0.1 us if known, otherwise as long as a
    /// measurement takes.
    [[nodiscard]] ClosestPoints closest_points(const Triangle& first,
                                               const Triangle& second) noexcept TACTUS_NONBLOCKING;

private:
    /// Corners of a feature: one, the two of an edge, or all three for the inside.
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
    /// First coordinate of one corner of each entry's first feature, a cheap filter.
    std::array<double, kKnown> first_keys_;
    /// First coordinate of one corner of each entry's second feature.
    std::array<double, kKnown> second_keys_;
    std::uint32_t oldest_{0}; ///< Entry that is replaced next.
};

} // namespace tactus
