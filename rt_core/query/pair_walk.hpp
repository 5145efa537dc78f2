// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/box_view.hpp"
#include "rt_core/query/pair_front.hpp"
#include "rt_core/query/tree_walk.hpp"

#include <array>

namespace tactus
{

/// Views of two models' boxes in each other's frames. Lengths are quanta of the object.
class MeshViews
{
public:
    MeshViews(const AbTree& tool, const AbTree& object,
              const MeshPlacement& place) noexcept TACTUS_NONBLOCKING;

    /// True if the tool is beyond the range of single precision; no other member may then be used.
    [[nodiscard]] bool is_beyond_kernels() const noexcept { return is_beyond_; }
    [[nodiscard]] const BoxView& of_tool() const noexcept { return of_tool_; }
    [[nodiscard]] const BoxView& of_object() const noexcept { return of_object_; }
    [[nodiscard]] double scale() const noexcept { return scale_; }
    /// Rounding of a coordinate by placement and single precision, beyond a share of it.
    [[nodiscard]] float slack() const noexcept { return slack_; }
    /// Upper bound on the coordinates' distance from the object's origin.
    [[nodiscard]] double farthest() const noexcept { return farthest_; }

private:
    [[nodiscard]] float slack_of(const AbTree& tool, const AbTree& object,
                                 const MeshPlacement& place) noexcept;

    double scale_;
    double farthest_{0.0};
    bool is_beyond_{false};
    float slack_;
    BoxView of_tool_;
    BoxView of_object_;
};

/// A depth-first walk of the pairs of blocks of two trees that may be near. The larger box of a
/// pair is opened, and its eight children are measured against the other at once. The nearest pair
/// is entered first. With a front the walk continues from the end of the last one and opens only
/// pairs that have come near since. Haptic thread. Takes about 50 ns for each opened node, 3 ns for
/// each unchanged pair. 25 KiB.
class PairWalk
{
public:
    struct Item
    {
        TreeRef tool;
        TreeRef object;
        Aabb tool_box; ///< Box in the tool's frame.
        Aabb object_box;
        float gap{0.0F}; ///< Lower bound on the distance, errors subtracted.
        std::uint8_t depth{0};
        std::uint8_t child{0};   ///< Index in the node that was opened.
        std::uint8_t entered{0}; ///< Children with entries in the front; `gap` is that of the
                                 ///< others.
    };

    /// Start of the walk in the tool.
    struct Start
    {
        TreeRef tool; ///< Root of the walk. A block's contents are not read, so it need not be in a
                      ///< tree.
        Aabb box;     ///< Box round the start, errors added.
        bool coarse_only{false}; ///< True if exact subtrees are left out.
    };

    /// Parameters of the next step.
    struct Sought
    {
        float bound{0.0F}; ///< Distance in quanta within which faces of two blocks matter. Never
                           ///< grows.
        /// Further direction to measure along, not longer than 1, from the object to the tool;
        /// null: unknown.
        const Vec3f* way{nullptr};
        /// True if subtrees without an exact face are left out, in both trees. Once true, it stays
        /// true.
        bool exact_only{false};
        TreeRef settled{}; ///< Block of the tool for which the search is over.
    };

    /// Both trees' boxes must be right (AbTree::refit). `views` must not be beyond the kernels.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             const Start& start) noexcept TACTUS_NONBLOCKING;
    /// Walks the whole tool. `front` must be that of the same two trees; null: none. `place` is the
    /// placement of the views, `exact_only` the value for the first step.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             PairFront* front, const MeshPlacement& place,
             bool exact_only) noexcept TACTUS_NONBLOCKING;

    /// The next pair of blocks; null if there is none or the budget is spent. Valid until the next
    /// call.
    [[nodiscard]] const Item* next_blocks(const Sought& sought) noexcept TACTUS_NONBLOCKING;
    /// Records a lower bound on the distance of the last pair of next_blocks(), errors subtracted.
    void settle(float gap) noexcept TACTUS_NONBLOCKING;

    /// A pair that a walk of the same boxes had not visited.
    struct Left
    {
        TreeRef tool;
        TreeRef object;
        float gap{0.0F};
    };
    static constexpr std::size_t kMostLeft = std::size_t{2} * kTreeStack;
    using LeftPairs = StaticVector<Left, kMostLeft>;
    /// Starts the walk with these pairs instead, which may have come nearer by `travel`.
    void go_on_with(const LeftPairs& pairs, double travel) noexcept TACTUS_NONBLOCKING;
    /// Stores the unvisited pairs, and the last pair of next_blocks() if it is not done.
    void keep_left(bool is_done, LeftPairs& pairs) const noexcept TACTUS_NONBLOCKING;

    /// Ends the walk at any point. Returns a lower bound on the unvisited pairs' distance, infinity
    /// after a complete walk.
    [[nodiscard]] float end() noexcept TACTUS_NONBLOCKING;

private:
    /// A box of the tool, placed in the object's frame.
    struct Seen // NOLINT(cppcoreguidelines-pro-type-member-init): a box comes with its ref.
    {
        TreeRef ref;
        KernelBox box;
    };
    static constexpr std::uint32_t kSeen = 16;
    static constexpr std::uint32_t kDepths = 2 * kTreeLevels + 2;

    [[nodiscard]] bool is_wanted(TreeRef tool) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool can_go_on(const MeshPlacement& place,
                                 bool exact_only) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool go_on() noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool skip_dropped() noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Item item_of(const PairFront::Entry& entry) const noexcept TACTUS_NONBLOCKING;
    void write(const PairFront::Entry& entry) noexcept TACTUS_NONBLOCKING;
    void keep(const Item& item) noexcept TACTUS_NONBLOCKING;
    void open(const Item& item, const Sought& sought) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_tool_larger(const Item& item) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const KernelBox& seen(const Item& item) noexcept TACTUS_NONBLOCKING;

    const AbTree& tool_;
    const AbTree& object_;
    const MeshViews& views_;
    WalkBudget& budget_;
    bool coarse_only_; ///< True if exact subtrees of the tool are left out.
    Item current_;
    std::array<Seen, kSeen> seen_; ///< Recently used boxes, at their index modulo kSeen.
    StaticVector<Item, kMostLeft> stack_;
    PairFront* front_{nullptr}; ///< Null if none is kept.
    // Entries of the last walk lie at the front's end and are read from there. Entries of this walk
    // are written from its beginning.
    std::uint32_t read_{PairFront::kRoom};
    std::uint32_t written_{0};
    bool has_overflowed_{false}; ///< True if nothing more is written; the next walk then starts at
                                 ///< the roots.
    float limit_{0.0F};          ///< Entries up to this value are tested again.
    std::array<std::uint8_t, kDepths> dropped_{}; ///< Children at each depth that are now far.
};

} // namespace tactus
