// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/query/walk_budget.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace tactus
{

/// Computes lower bounds on the distances from the probe to the faces in `lanes`, in quanta.
inline void bound_faces(const Kernels& kernels, const BlockGeometry& block, std::uint32_t lanes,
                        const KernelProbe& probe, FaceBounds& bounds) noexcept
{
    float unlimited = std::numeric_limits<float>::infinity();
    static_cast<void>(kernels.face_bounds(block.coordinates.front().data(),
                                          block.corners.front().data(), probe, lanes, 0, 0.0F,
                                          unlimited, bounds));
}

/// Unvisited subtree and a lower bound on its distance, in quanta.
struct WalkItem
{
    TreeRef ref;
    float gap{0.0F};
};

/// Depth-first traversal of the blocks near a point, or near a box given as a KernelBox. The
/// nearest child is entered first.
template <typename Probe>
class TreeWalk
{
public:
    TreeWalk(const AbTree& tree, const Probe& probe, WalkBudget& budget) noexcept
        : tree_(tree), probe_(probe), budget_(budget)
    {
        if (!tree.root().is_none())
        {
            stack_.push_back({tree.root(), 0.0F});
        }
    }

    /// Returns the next block whose box may hold a face within `bound` quanta; kNoNode if there is
    /// none or the budget is spent. With `coarse_only`, subtrees of exact faces are left out.
    [[nodiscard]] std::uint32_t next_block(float bound, bool coarse_only) noexcept
    {
        while (!stack_.empty())
        {
            const WalkItem item = stack_[stack_.size() - 1];
            if (item.gap > bound)
            {
                stack_.pop_back();
                continue;
            }
            if (!budget_.take_node())
            {
                return kNoNode;
            }
            stack_.pop_back();
            if (item.ref.is_block())
            {
                return item.ref.index();
            }
            push_children(tree_.node(item.ref.index()), bound, coarse_only);
        }
        return kNoNode;
    }

    /// Parts not visited because the budget was spent; empty after a complete traversal. Each gap
    /// is a lower bound for all of the part.
    [[nodiscard]] std::span<const WalkItem> left() const noexcept { return stack_.view(); }

private:
    void push_children(const AbNode& node, float bound, bool coarse_only) noexcept
    {
        TACTUS_ASSERT(node.in_use);
        alignas(32) std::array<float, kNodeChildren> gaps; // NOLINT: the kernel fills it.
        const std::uint32_t wanted = coarse_only ? node.mask & node.coarse : node.mask;
        std::uint32_t near = AabbVolume::child_gaps(tree_.kernels(), node.volumes, probe_, wanted,
                                                    bound, gaps.data());
        const std::size_t first = stack_.size();
        for (std::size_t nearest = first; near != 0; near &= near - 1)
        {
            const auto child = static_cast<std::uint32_t>(std::countr_zero(near));
            const TreeRef ref = node.children[child];
            tree_.prefetch(ref);
            stack_.push_back({ref, gaps[child]});
            const std::size_t top = stack_.size() - 1;
            if (top == first || gaps[child] < stack_[nearest].gap)
            {
                nearest = top;
            }
            if ((near & (near - 1)) == 0)
            {
                std::swap(stack_[nearest], stack_[top]);
            }
        }
    }

    const AbTree& tree_;
    const Probe& probe_;
    WalkBudget& budget_;
    StaticVector<WalkItem, kTreeStack> stack_;
};

} // namespace tactus
