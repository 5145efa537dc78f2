// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/node.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/shapes.hpp"
#include "rt_core/query/mesh_placement.hpp"
#include "rt_core/spm/error_code.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// Pairs of boxes that a walk opened or reached, a tree in preorder, for the next walk of the same
/// two models. Each pair stores the travel of the tool up to which it needs no new test. A walk
/// therefore visits only pairs whose travel is used up.
///
/// A front is invalid after a change of either tree; the walk then starts at the roots. 32 KiB.
struct PairFront
{
    struct Entry // NOLINT(cppcoreguidelines-pro-type-member-init): written whole.
    {
        TreeRef tool;
        TreeRef object;
        /// Gap of the pair plus travel at the entry, in quanta of the object. Parts of this pair
        /// without entries are at least `until` less the tool's travel apart.
        float until;
        std::uint8_t depth;
        std::uint8_t child;   ///< Index of the pair's box as a child of the node that was opened.
        std::uint8_t entered; ///< Children that have entries, one bit each.
        std::uint8_t reserved;
    };
    static_assert(sizeof(Entry) == 16);
    static constexpr std::uint32_t kRoom = 2'048;
    /// Number of walks that store nothing after a walk whose pairs did not fit.
    static constexpr std::uint32_t kPause = 16;
    /// Largest number of tool-object pairs with a front; those of highest priority get one.
    static constexpr std::uint32_t kFronts = 4;

    std::uint32_t count{0}; ///< Number of entries; 0: nothing is known.
    std::uint32_t pause{0};
    /// True if open faces (coarse and above the tolerance) were left out.
    bool leaves_open{false};
    /// Largest errors of the tool's and the object's faces that counted as the surface.
    ErrorCode tool_tolerance{0};
    ErrorCode tolerance{0};
    std::uint64_t tool_change{0};
    std::uint64_t object_change{0};
    MeshPlacement place;
    double travel{0.0}; ///< Travel of the tool since the first entry, in quanta of the object.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): none is read beyond the count.
    std::array<Entry, kRoom> entries;

    // NOLINTNEXTLINE(modernize-use-equals-default): `= default` would zero all.
    PairFront() noexcept {} // NOLINT(cppcoreguidelines-pro-type-member-init)
};

/// Upper bound on the displacement of the sphere's points from the placement `before` to `now`. NaN
/// if either is invalid.
[[nodiscard]] double motion_between(const MeshPlacement& before, const MeshPlacement& now,
                                    const Sphere& sphere) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
