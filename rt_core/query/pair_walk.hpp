// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/box_view.hpp"
#include "rt_core/query/pair_front.hpp"
#include "rt_core/query/tree_walk.hpp"

#include <array>

namespace tactus
{

/// How two models' frames lie in each other, for boxes of either as the other's tree sees them.
/// Lengths are quanta of the object.
class MeshViews
{
public:
    MeshViews(const AbTree& tool, const AbTree& object,
              const MeshPlacement& place) noexcept TACTUS_NONBLOCKING;

    /// The tool is so far away that single precision does not hold it; nothing else may be asked.
    [[nodiscard]] bool is_beyond_kernels() const noexcept { return is_beyond_; }
    [[nodiscard]] const BoxView& of_tool() const noexcept { return of_tool_; }
    [[nodiscard]] const BoxView& of_object() const noexcept { return of_object_; }
    [[nodiscard]] double scale() const noexcept { return scale_; }
    /// What placing and single precision round of any coordinate, beyond a share of it.
    [[nodiscard]] float slack() const noexcept { return slack_; }
    /// No coordinate is farther from the object's origin.
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

/// A depth-first walk of the pairs of blocks of two trees that may be near. Of a pair of boxes the
/// larger one is opened, and its eight children are measured against the other at once; the nearest
/// pair is entered first. With a front it goes on from where the last walk ended, and opens only
/// what has come near since. Haptic thread; some 50 ns a node opened, 3 ns a pair that stays as it
/// was. 25 KiB.
class PairWalk
{
public:
    struct Item
    {
        TreeRef tool;
        TreeRef object;
        Aabb tool_box; ///< In the tool's frame.
        Aabb object_box;
        float gap{0.0F}; ///< They are at least this far apart, errors taken off.
        std::uint8_t depth{0};
        std::uint8_t child{0};   ///< Which of the node that was opened.
        std::uint8_t entered{0}; ///< Children that the front has entries of; `gap` is the others'.
    };

    /// What is walked of the tool.
    struct Start
    {
        TreeRef tool; ///< A block is never looked into: it may be any that is in no tree.
        Aabb box;     ///< Round it, errors added.
        bool coarse_only{false}; ///< Exact subtrees are left out.
    };

    /// What is looked for next.
    struct Sought
    {
        float bound{0.0F}; ///< In quanta: something of two blocks may be within it. Never grows.
        /// One more direction to measure along, not longer than 1 and from the object to the tool;
        /// null when none is known.
        const Vec3f* way{nullptr};
        /// Subtrees without an exact face are left out, of both trees. Once true, it stays.
        bool exact_only{false};
        TreeRef settled{}; ///< A block of the tool of which nothing more is looked for.
    };

    /// Both trees' boxes must be right (AbTree::refit). `views` must not be beyond the kernels.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             const Start& start) noexcept TACTUS_NONBLOCKING;
    /// Of all of the tool, by a front that is of the same two trees; null: by none. `place` is what
    /// the views were made of, and `exact_only` the first question's.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             PairFront* front, const MeshPlacement& place,
             bool exact_only) noexcept TACTUS_NONBLOCKING;

    /// The next pair of blocks; null when there is none or the budget is spent. Good until the next
    /// call.
    [[nodiscard]] const Item* next_blocks(const Sought& sought) noexcept TACTUS_NONBLOCKING;
    /// The pair that next_blocks() gave last is at least this far apart, errors taken off.
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
    /// Instead of at its start the walk begins with these, which may have come nearer by `travel`.
    void go_on_with(const LeftPairs& pairs, double travel) noexcept TACTUS_NONBLOCKING;
    /// What is not visited yet, and the pair that next_blocks() gave last where that is not done.
    void keep_left(bool is_done, LeftPairs& pairs) const noexcept TACTUS_NONBLOCKING;

    /// Ends the walk, wherever it is: what was not visited is at least this far apart, infinitely
    /// after a complete walk.
    [[nodiscard]] float end() noexcept TACTUS_NONBLOCKING;

private:
    /// A box of the tool as the object sees it.
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
    bool coarse_only_; ///< Of the tool.
    Item current_;
    std::array<Seen, kSeen> seen_; ///< Asked for last, many times each; at its place modulo kSeen.
    StaticVector<Item, kMostLeft> stack_;
    PairFront* front_{nullptr}; ///< Null where none is kept.
    // The entries of the last walk stand at the front's end and are read from there, those of this
    // one are written from its beginning.
    std::uint32_t read_{PairFront::kRoom};
    std::uint32_t written_{0};
    bool has_overflowed_{false}; ///< Nothing more is written, and the next walk knows nothing.
    float limit_{0.0F};          ///< Entries up to this are looked at again.
    std::array<std::uint8_t, kDepths> dropped_{}; ///< Children at each depth that are now far.
};

} // namespace tactus
