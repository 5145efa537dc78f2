// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/pair_walk.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// A split coordinate leaves 2^-48 of itself; the rest is for what the split rounds.
constexpr double kSplitRounding = 0x1p-46;
constexpr double kLeastSlack = 0x1p-40;

/// Only a choice hangs on it: single precision is enough.
float diagonal_sq(const Aabb& box) noexcept
{
    float sum = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const float side = box.high[axis] - box.low[axis];
        sum += side * side;
    }
    return sum;
}

/// The other way round, in the tool's frame.
Vec3f seen_from_tool(const Vec3f& way, const BoxView& of_tool) noexcept
{
    Vec3f turned{};
    for (std::size_t along = 0; along < 3; ++along)
    {
        const std::array<float, 3>& axis = of_tool.axis(along);
        turned[along] = -(way[0] * axis[0] + way[1] * axis[1] + way[2] * axis[2]);
    }
    return turned;
}

} // namespace

MeshViews::MeshViews(const AbTree& tool, const AbTree& object, const MeshPlacement& place) noexcept
    : scale_(place.place.scale)
    , slack_(slack_of(tool, object, place))
    , of_tool_(place, 1.0 / static_cast<double>(object.quantum_m()), slack_)
    , of_object_(place.inverse(), scale_ / static_cast<double>(object.quantum_m()), slack_)
{
}

/// Of the corners that are farthest out: good for all.
float MeshViews::slack_of(const AbTree& tool, const AbTree& object,
                          const MeshPlacement& place) noexcept
{
    const Ball tool_ball = ball_round(tool.box());
    const Ball object_ball = ball_round(object.box());
    const double tool_reach_m = tool_ball.center.norm() + tool_ball.radius;
    const double object_reach_m = object_ball.center.norm() + object_ball.radius;
    const auto quantum_m = static_cast<double>(object.quantum_m());
    // Of either, in the other's frame and in metres of the object's.
    const double placed_m =
        place.place.translation_m.norm() + scale_ * (tool_reach_m + place.offset_m.norm());
    farthest_ = (placed_m + object_reach_m) / quantum_m;
    // NOLINTNEXTLINE(readability-simplify-boolean-expr): the simpler one lets NaN pass.
    is_beyond_ = !(farthest_ < kFarQuanta);
    // Placed once each way, to either of two precisions.
    const double share = 2.0 * kPoseRounding + kSplitRounding;
    return is_beyond_ ? 0.0F : round_up_to_float(farthest_ * share + kLeastSlack);
}

PairWalk::PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views,
                   WalkBudget& budget, const Start& start) noexcept
    : tool_(tool), object_(object), views_(views), budget_(budget), coarse_only_(start.coarse_only)
{
    TACTUS_ASSERT(!views.is_beyond_kernels());
    for (Seen& seen : seen_)
    {
        seen.ref = {};
    }
    if (!start.tool.is_none() && !object.root().is_none() && is_wanted(start.tool))
    {
        stack_.push_back({start.tool, object.root(), start.box, object.box(), 0.0F});
    }
}

/// Whether anything below is.
bool PairWalk::is_wanted(TreeRef tool) const noexcept
{
    return !coarse_only_ || (tool.is_block() ? tool_.side(tool.index()).coarse
                                             : tool_.node(tool.index()).coarse) != 0;
}

const PairWalk::Item* PairWalk::next_blocks(const Sought& sought) noexcept
{
    while (!stack_.empty())
    {
        const Item& next = stack_[stack_.size() - 1];
        if (next.gap > sought.bound || next.tool == sought.settled)
        {
            stack_.pop_back();
            continue;
        }
        if (!budget_.take_node())
        {
            return nullptr;
        }
        current_ = stack_.pop_back();
        if (current_.tool.is_block() && current_.object.is_block())
        {
            return &current_;
        }
        open(current_, sought);
    }
    return nullptr;
}

bool PairWalk::is_tool_larger(const Item& item) const noexcept
{
    const auto scale = static_cast<float>(views_.scale());
    return scale * scale * diagonal_sq(item.tool_box) > diagonal_sq(item.object_box);
}

const KernelBox& PairWalk::seen(const Item& item) noexcept
{
    Seen& seen = seen_[item.tool.value % kSeen];
    if (seen.ref != item.tool)
    {
        seen = {item.tool, views_.of_tool().of(item.tool_box)};
    }
    return seen.box;
}

void PairWalk::open(const Item& item, const Sought& sought) noexcept
{
    TACTUS_ASSERT(!item.tool.is_block() || !item.object.is_block());
    const bool opens_tool =
        !item.tool.is_block() && (item.object.is_block() || is_tool_larger(item));
    const AbTree& tree = opens_tool ? tool_ : object_;
    const AbNode& node = tree.node(opens_tool ? item.tool.index() : item.object.index());
    TACTUS_ASSERT(node.in_use);
    const KernelBox& other = opens_tool ? views_.of_object().of(item.object_box) : seen(item);
    const float* boxes = node.volumes.low.front().data();
    alignas(32) std::array<float, kNodeChildren> gaps; // NOLINT: the kernel fills it.
    const std::uint32_t wanted = (opens_tool && coarse_only_ ? node.coarse : node.mask) &
                                 (sought.exact_only ? node.exact : node.mask);
    std::uint32_t near = tree.kernels().box_gaps(boxes, other, wanted, sought.bound, gaps.data());
    if (sought.way != nullptr && near != 0)
    {
        const Vec3f turned =
            opens_tool ? seen_from_tool(*sought.way, views_.of_tool()) : *sought.way;
        near = tree.kernels().boxes_along(boxes, other, turned.data(), near, sought.bound,
                                          gaps.data());
    }
    const std::size_t first = stack_.size();
    for (; near != 0; near &= near - 1)
    {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(near));
        const TreeRef ref = node.children[child];
        const Aabb box = node.box_of(child);
        tree.prefetch(ref);
        const float gap = std::max(gaps[child], item.gap);
        stack_.push_back(opens_tool ? Item{ref, item.object, box, item.object_box, gap}
                                    : Item{item.tool, ref, item.tool_box, box, gap});
        // The nearest on top, the others below in any order.
        const std::size_t top = stack_.size() - 1;
        if (top > first && stack_[top].gap > stack_[top - 1].gap)
        {
            std::swap(stack_[top], stack_[top - 1]);
        }
    }
}

} // namespace tactus
