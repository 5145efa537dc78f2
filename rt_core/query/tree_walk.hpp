// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// A traversal's allowance and what it used; when it is spent the traversal stops where it is.
struct WalkBudget
{
    std::uint32_t nodes{0};     ///< Nodes and blocks that may still be visited.
    std::uint32_t triangles{0}; ///< Triangles that may still be tested.
    std::uint32_t nodes_visited{0};
    std::uint32_t triangles_tested{0};

    [[nodiscard]] bool take_node() noexcept
    {
        if (nodes_visited == nodes)
        {
            return false;
        }
        ++nodes_visited;
        return true;
    }
    [[nodiscard]] bool take_triangles(std::uint32_t count) noexcept
    {
        if (triangles - triangles_tested < count)
        {
            return false;
        }
        triangles_tested += count;
        return true;
    }
};

/// A box's squared distance is a sum of three rounded squares: never more than this too large.
inline constexpr double kBoxDistanceSlack = 1.0 - 1e-15;

/// Something still to be visited and a lower bound on its distance, squared.
struct WalkItem
{
    TreeRef ref;
    double distance_sq{0.0};
};

/// A depth-first traversal of the blocks near a point. The nearest child is entered first.
class TreeWalk
{
public:
    TreeWalk(const AbTree& tree, const Vec3& center_m, WalkBudget& budget) noexcept
        : tree_(tree), center_{center_m.x(), center_m.y(), center_m.z()}, budget_(budget)
    {
        if (!tree.root().is_none())
        {
            stack_.push_back({tree.root(), 0.0});
        }
    }

    /// The next block whose box may hold something nearer than sqrt(bound_sq), or kNoNode when
    /// there is none or the budget is spent. With `coarse_only`, exact subtrees are left out.
    [[nodiscard]] std::uint32_t next_block(double bound_sq, bool coarse_only) noexcept
    {
        while (!stack_.empty())
        {
            const WalkItem item = stack_[stack_.size() - 1];
            if (item.distance_sq * kBoxDistanceSlack > bound_sq)
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
            push_children(tree_.node(item.ref.index()), bound_sq, coarse_only);
        }
        return kNoNode;
    }

    /// What was not visited when the budget was spent; empty after a complete traversal. Each
    /// item's bound is a lower bound for everything in it.
    [[nodiscard]] std::span<const WalkItem> left() const noexcept { return stack_.view(); }

private:
    void push_children(const AbNode& node, double bound_sq, bool coarse_only) noexcept
    {
        std::array<double, kNodeChildren> distance_sq{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            for (std::size_t i = 0; i < kNodeChildren; ++i)
            {
                const double below = static_cast<double>(node.low[axis][i]) - center_[axis];
                const double above = center_[axis] - static_cast<double>(node.high[axis][i]);
                const double outside = below > above ? below : above;
                const double gap = outside > 0.0 ? outside : 0.0;
                distance_sq[i] += gap * gap;
            }
        }
        const std::uint32_t wanted = coarse_only ? node.mask & node.coarse : node.mask;
        std::uint32_t nearest = kNodeChildren;
        for (std::uint32_t used = wanted; used != 0; used &= used - 1)
        {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(used));
            if (distance_sq[i] * kBoxDistanceSlack > bound_sq)
            {
                continue;
            }
            if (nearest == kNodeChildren || distance_sq[i] < distance_sq[nearest])
            {
                if (nearest != kNodeChildren)
                {
                    stack_.push_back({node.children[nearest], distance_sq[nearest]});
                }
                nearest = i;
                continue;
            }
            stack_.push_back({node.children[i], distance_sq[i]});
        }
        if (nearest != kNodeChildren)
        {
            stack_.push_back({node.children[nearest], distance_sq[nearest]});
        }
    }

    const AbTree& tree_;
    std::array<double, 3> center_;
    WalkBudget& budget_;
    StaticVector<WalkItem, kTreeStack> stack_;
};

} // namespace tactus
