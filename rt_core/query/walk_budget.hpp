// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/work_budget.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// Allowance of one more traversal in a frame whose traversals have used `used` nodes or triangles;
/// `each` is the allowance of one traversal.
[[nodiscard]] constexpr std::uint32_t walk_left(std::uint32_t each, std::uint32_t used) noexcept
{
    const std::uint64_t all = std::uint64_t{kFrameWalks} * each;
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(each, all - std::min<std::uint64_t>(all, used)));
}

/// Allowance and use of one traversal, which stops when the allowance is spent.
struct WalkBudget
{
    std::uint32_t nodes{0};     ///< Allowance of nodes and blocks.
    std::uint32_t triangles{0}; ///< Allowance of triangles.
    std::uint32_t nodes_visited{0};
    std::uint32_t triangles_tested{0};
    bool is_spent{false};       ///< True if a step was refused for lack of allowance.
    WorkBudget* frame{nullptr}; ///< Budget of the frame, which is charged as well; null: none.

    [[nodiscard]] bool take_node(std::uint32_t cost = WorkCost::node) noexcept
    {
        TACTUS_ASSERT(nodes_visited <= nodes);
        if (nodes_visited == nodes || !draw(cost))
        {
            is_spent = true;
            return false;
        }
        ++nodes_visited;
        return true;
    }
    [[nodiscard]] bool is_half_spent() const noexcept
    {
        return nodes_visited > nodes / 2 || triangles_tested > triangles / 2;
    }
    /// Takes up to `count` nodes; returns the number taken.
    [[nodiscard]] std::uint32_t take_nodes(std::uint32_t count) noexcept
    {
        TACTUS_ASSERT(nodes_visited <= nodes);
        const bool is_drawn = draw(count * WorkCost::node);
        const std::uint32_t taken = is_drawn ? std::min(count, nodes - nodes_visited) : 0;
        is_spent = is_spent || taken < count;
        nodes_visited += taken;
        return taken;
    }
    [[nodiscard]] bool take_triangles(std::uint32_t count,
                                      std::uint32_t cost = WorkCost::triangle) noexcept
    {
        TACTUS_ASSERT(triangles_tested <= triangles);
        if (triangles - triangles_tested < count || !draw(count * cost))
        {
            is_spent = true;
            return false;
        }
        triangles_tested += count;
        return true;
    }
    /// Charges the frame for work that is done in any case.
    void spend(std::uint32_t cost) const noexcept
    {
        if (frame != nullptr)
        {
            frame->spend(cost);
        }
    }

private:
    [[nodiscard]] bool draw(std::uint32_t cost) const noexcept
    {
        return frame == nullptr || frame->try_take(cost);
    }
};

} // namespace tactus
