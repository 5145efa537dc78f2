// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/box_view.hpp"
#include "rt_core/query/tree_walk.hpp"

#include <array>
#include <span>

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
/// pair is entered first. Haptic thread; some 50 ns a node opened. 24 KiB.
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
        float bound{0.0F}; ///< In quanta: something of two blocks may be within it.
        /// One more direction to measure along, not longer than 1 and from the object to the tool;
        /// null when none is known.
        const Vec3f* way{nullptr};
        bool exact_only{false}; ///< Subtrees without an exact face are left out, of both trees.
        TreeRef settled{};      ///< A block of the tool of which nothing more is looked for.
    };

    /// Both trees' boxes must be right (AbTree::refit). `views` must not be beyond the kernels.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             const Start& start) noexcept TACTUS_NONBLOCKING;
    /// Of all of the tool.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views,
             WalkBudget& budget) noexcept TACTUS_NONBLOCKING
        : PairWalk(tool, object, views, budget, {tool.root(), tool.box()})
    {
    }

    /// The next pair of blocks; null when there is none or the budget is spent. Good until the next
    /// call.
    [[nodiscard]] const Item* next_blocks(const Sought& sought) noexcept TACTUS_NONBLOCKING;

    /// What was not visited when the budget was spent; empty after a complete walk.
    [[nodiscard]] std::span<const Item> left() const noexcept { return stack_.view(); }

private:
    /// A box of the tool as the object sees it.
    struct Seen // NOLINT(cppcoreguidelines-pro-type-member-init): a box comes with its ref.
    {
        TreeRef ref;
        KernelBox box;
    };
    static constexpr std::uint32_t kSeen = 32;

    [[nodiscard]] bool is_wanted(TreeRef tool) const noexcept TACTUS_NONBLOCKING;
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
    StaticVector<Item, std::size_t{2} * kTreeStack> stack_;
};

} // namespace tactus
