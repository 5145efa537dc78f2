// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/query/other_surface.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// The pairs of boxes that a walk opened or came to, kept for the next walk of the same two models:
/// a tree in preorder. Each pair says how far the tool may go until it has to be looked at again,
/// so a walk looks only at those whose way is used up.
///
/// What is kept is proven by boxes and faces as they were: a tree that has changed since is walked
/// from its root. 32 KiB.
struct PairFront
{
    struct Entry // NOLINT(cppcoreguidelines-pro-type-member-init): written whole.
    {
        TreeRef tool;
        TreeRef object;
        /// What has no entries below this one, some of its children or all that it is, is farther
        /// apart than this less the tool's travel.
        float until;
        std::uint8_t depth;
        std::uint8_t child;   ///< Which of the node that was opened above.
        std::uint8_t entered; ///< Children that have entries.
        std::uint8_t reserved;
    };
    static_assert(sizeof(Entry) == 16);
    static constexpr std::uint32_t kRoom = 2'048;
    /// After a walk that found no room for its pairs so many keep nothing.
    static constexpr std::uint32_t kPause = 16;
    /// So many pairs of a tool and an object have one at once, those of highest priority.
    static constexpr std::uint32_t kFronts = 4;

    std::uint32_t count{0}; ///< 0: nothing is known.
    std::uint32_t pause{0};
    bool exact_only{false}; ///< Subtrees without an exact face were left out.
    std::uint64_t tool_change{0};
    std::uint64_t object_change{0};
    MeshPlacement place;
    double travel{0.0}; ///< The tool's way since the first entry, in the object's quanta.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): none is read beyond the count.
    std::array<Entry, kRoom> entries;

    // NOLINTNEXTLINE(modernize-use-equals-default): `= default` would zero all.
    PairFront() noexcept {} // NOLINT(cppcoreguidelines-pro-type-member-init)
};

/// No point of the sphere that `before` places is farther from where `now` does; not a number where
/// either place is none.
[[nodiscard]] double motion_between(const MeshPlacement& before, const MeshPlacement& now,
                                    const Sphere& sphere) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
