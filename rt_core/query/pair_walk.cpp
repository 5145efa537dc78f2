// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/pair_walk.hpp"

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus
{

namespace
{

/// Largest travel of the tool for which entries are used, in quanta: no model is larger, and single
/// precision is right to a quantum.
constexpr double kMostTravel = 0x1p24;
constexpr float kNothingLeft = std::numeric_limits<float>::infinity();

float least_of(const std::array<float, kNodeChildren>& gaps, std::uint32_t children) noexcept
{
    float least = kNothingLeft;
    for (; children != 0; children &= children - 1)
    {
        least = std::min(least, gaps[static_cast<std::size_t>(std::countr_zero(children))]);
    }
    return least;
}

/// Squared diagonal of a box in single precision, which is enough for a choice of order.
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

/// Returns the opposite of `way`, in the tool's frame.
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

double motion_between(const MeshPlacement& before, const MeshPlacement& now,
                      const Sphere& sphere) noexcept
{
    // The difference of two rotations has two equal singular values, and the third is zero. So no
    // point moves by more than its Frobenius norm over the root of two.
    constexpr double kOfTwo = 0.7072;
    const Mat3 turned =
        now.place.scale * now.place.rotation - before.place.scale * before.place.rotation;
    const double of_turn = now.place.scale == before.place.scale ? kOfTwo : 1.0;
    return ((now.local_to_world(sphere.center) - before.local_to_world(sphere.center)).norm() +
            of_turn * turned.norm() * sphere.radius) *
           kWidened;
}

MeshViews::MeshViews(const AbTree& tool, const AbTree& object, const MeshPlacement& place) noexcept
    : scale_(place.place.scale)
    , slack_(slack_of(tool, object, place))
    , of_tool_(place, 1.0 / static_cast<double>(object.quantum_m()), slack_)
    , of_object_(place.inverse(), scale_ / static_cast<double>(object.quantum_m()), slack_)
{
}

/// Bound on the rounding of any placed coordinate, from that of the farthest corner; sets
/// is_beyond_ and farthest_, too.
float MeshViews::slack_of(const AbTree& tool, const AbTree& object,
                          const MeshPlacement& place) noexcept
{
    const Sphere tool_sphere = sphere_round(tool.box());
    const Sphere object_sphere = sphere_round(object.box());
    const double tool_reach_m = tool_sphere.center.norm() + tool_sphere.radius;
    const double object_reach_m = object_sphere.center.norm() + object_sphere.radius;
    const auto quantum_m = static_cast<double>(object.quantum_m());
    // Largest distance of either model from the other's origin, in metres of the object's frame.
    const double placed_m =
        place.place.translation_m.norm() + scale_ * (tool_reach_m + place.offset_m.norm());
    farthest_ = (placed_m + object_reach_m) / quantum_m;
    // NOLINTNEXTLINE(readability-simplify-boolean-expr): the simpler one lets NaN pass.
    is_beyond_ = !(farthest_ < kFarQuanta);
    // Boxes are placed in both directions, in double precision or as two floats.
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
        stack_.push_back({start.tool, object.root(), start.box, object.box()});
    }
}

PairWalk::PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views,
                   WalkBudget& budget, const Surfaces& surfaces) noexcept
    : PairWalk(tool, object, views, budget, {tool.root(), tool.box()})
{
    is_tolerant_ = (surfaces.tool_tolerance | surfaces.tolerance) != 0;
    PairFront* const front = surfaces.front;
    if (front == nullptr || stack_.empty())
    {
        return;
    }
    if (front->pause > 0)
    {
        --front->pause;
        return;
    }
    front_ = front;
    if (can_resume(surfaces))
    {
        stack_.clear();
        read_ = PairFront::kRoom - front->count;
        std::copy_backward(front->entries.begin(), front->entries.begin() + front->count,
                           front->entries.end());
    }
    else
    {
        front->travel = 0.0;
        front->leaves_open = false;
        front->tool_tolerance = surfaces.tool_tolerance;
        front->tolerance = surfaces.tolerance;
        front->tool_change = tool.last_change();
        front->object_change = object.last_change();
    }
    front->place = surfaces.place;
    front->count = 0; // The front is invalid until the walk has ended.
}

/// Adds the tool's travel since the last walk to the front. True if the front's entries are for the
/// same trees and include everything requested.
bool PairWalk::can_resume(const Surfaces& surfaces) noexcept
{
    const MeshPlacement& place = surfaces.place;
    if (front_->count == 0 || front_->tool_change != tool_.last_change() ||
        front_->object_change != object_.last_change() ||
        (front_->leaves_open && !surfaces.leaves_open) ||
        front_->tool_tolerance != surfaces.tool_tolerance ||
        front_->tolerance != surfaces.tolerance || front_->place.place.scale != place.place.scale)
    {
        return false;
    }
    const double motion_m = motion_between(front_->place, place, sphere_round(tool_.box()));
    if (motion_m > 0.0)
    {
        front_->travel += (motion_m / static_cast<double>(object_.quantum_m())) * kRoundedUp +
                          2.0 * static_cast<double>(views_.slack());
    }
    return motion_m >= 0.0 && front_->travel < kMostTravel;
}

/// True if a subtree of the tool holds faces that the walk visits.
bool PairWalk::is_wanted(TreeRef tool) const noexcept
{
    return !coarse_only_ || (tool.is_block() ? tool_.side(tool.index()).coarse
                                             : tool_.node(tool.index()).coarse) != 0;
}

const PairWalk::Item* PairWalk::next_blocks(const Sought& sought) noexcept
{
    if (front_ != nullptr)
    {
        front_->leaves_open = front_->leaves_open || sought.leaves_open;
        limit_ = round_up_to_float(static_cast<double>(sought.bound) + front_->travel);
    }
    for (bool has_more = true; has_more; has_more = try_step())
    {
        while (!stack_.empty())
        {
            const Item& next = stack_[stack_.size() - 1];
            if (next.gap > sought.bound || next.tool == sought.settled)
            {
                keep(stack_.pop_back());
                continue;
            }
            if (!budget_.take_node(WorkCost::pair_node))
            {
                return nullptr;
            }
            current_ = stack_.pop_back();
            if (current_.tool.is_block() && current_.object.is_block())
            {
                keep(current_);
                return &current_;
            }
            open(current_, sought);
        }
    }
    return nullptr;
}

/// Copies entries of the last walk up to the next one to be tested, which goes on the stack. False
/// if there is none.
bool PairWalk::try_step() noexcept
{
    while (read_ != PairFront::kRoom)
    {
        if (skip_dropped())
        {
            continue;
        }
        const PairFront::Entry entry = front_->entries[read_];
        ++read_;
        if (!(entry.until > limit_))
        {
            stack_.push_back(item_of(entry));
            return true;
        }
        write(entry);
    }
    return false;
}

/// Skips the next entry of the last walk with its subtree, if the present walk dropped it as far.
bool PairWalk::skip_dropped() noexcept
{
    const std::uint32_t depth = front_->entries[read_].depth;
    TACTUS_ASSERT(depth + 1 < kDepths);
    if ((std::uint32_t{dropped_[depth]} >> front_->entries[read_].child & 1U) == 0)
    {
        dropped_[depth + 1] = 0;
        return false;
    }
    ++read_;
    while (read_ != PairFront::kRoom && front_->entries[read_].depth > depth)
    {
        ++read_;
    }
    return true;
}

PairWalk::Item PairWalk::item_of(const PairFront::Entry& entry) const noexcept
{
    const double gap = static_cast<double>(entry.until) - front_->travel;
    return {entry.tool,
            entry.object,
            tool_.box_of(entry.tool),
            object_.box_of(entry.object),
            gap > 0.0 ? round_down_to_float(gap) : 0.0F,
            entry.depth,
            entry.child,
            entry.entered};
}

void PairWalk::write(const PairFront::Entry& entry) noexcept
{
    if (front_ == nullptr || has_overflowed_)
    {
        return;
    }
    has_overflowed_ = written_ == read_;
    if (!has_overflowed_)
    {
        front_->entries[written_++] = entry;
    }
}

void PairWalk::keep(const Item& item) noexcept
{
    if (front_ != nullptr)
    {
        const double until = static_cast<double>(item.gap) + front_->travel;
        write({item.tool, item.object, round_down_to_float(until), item.depth, item.child,
               item.entered, 0});
    }
}

void PairWalk::end_pair(float gap) noexcept
{
    if (front_ != nullptr && !has_overflowed_)
    {
        TACTUS_ASSERT(written_ > 0);
        float& until = front_->entries[written_ - 1].until;
        until = std::max(until, round_down_to_float(static_cast<double>(gap) + front_->travel));
    }
}

void PairWalk::resume(const LeftPairs& pairs, double travel) noexcept
{
    TACTUS_ASSERT(front_ == nullptr);
    stack_.clear();
    for (const Left& left : pairs)
    {
        const double gap = static_cast<double>(left.gap) - travel;
        stack_.push_back({left.tool, left.object, tool_.box_of(left.tool),
                          object_.box_of(left.object),
                          gap > 0.0 ? round_down_to_float(gap) : 0.0F});
    }
}

void PairWalk::keep_left(bool is_done, LeftPairs& pairs) const noexcept
{
    pairs.clear();
    for (const Item& item : stack_)
    {
        pairs.push_back({item.tool, item.object, item.gap});
    }
    if (!is_done)
    {
        pairs.push_back({current_.tool, current_.object, current_.gap});
    }
}

float PairWalk::end() noexcept
{
    float left = kNothingLeft;
    for (; !stack_.empty(); stack_.pop_back())
    {
        const Item& item = stack_[stack_.size() - 1];
        left = std::min(left, item.gap);
        keep(item);
    }
    while (try_step())
    {
        const Item item = stack_.pop_back();
        left = std::min(left, item.gap);
        keep(item);
    }
    if (front_ != nullptr)
    {
        front_->count = has_overflowed_ ? 0 : written_;
        front_->pause = has_overflowed_ ? PairFront::kPause : 0;
    }
    return left;
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
                                 (sought.leaves_open && !is_tolerant_ ? node.exact : node.mask);
    std::uint32_t near = tree.kernels().box_gaps(boxes, other, wanted, sought.bound, gaps.data());
    if (sought.way != nullptr && near != 0)
    {
        const Vec3f turned =
            opens_tool ? seen_from_tool(*sought.way, views_.of_tool()) : *sought.way;
        near = tree.kernels().boxes_along(boxes, other, turned.data(), near, sought.bound,
                                          gaps.data());
    }
    if (front_ != nullptr)
    {
        Item opened = item;
        opened.gap = least_of(gaps, wanted & ~near);
        opened.entered = static_cast<std::uint8_t>(near);
        keep(opened);
        dropped_[item.depth + 1U] = static_cast<std::uint8_t>(item.entered & ~near);
        near &= ~std::uint32_t{item.entered};
    }
    const std::size_t first = stack_.size();
    for (; near != 0; near &= near - 1)
    {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(near));
        const TreeRef ref = node.children[child];
        const Aabb box = node.box_of(child);
        tree.prefetch(ref);
        const float gap = std::max(gaps[child], item.gap);
        const auto depth = static_cast<std::uint8_t>(item.depth + 1U);
        const auto number = static_cast<std::uint8_t>(child);
        stack_.push_back(opens_tool
                             ? Item{ref, item.object, box, item.object_box, gap, depth, number}
                             : Item{item.tool, ref, item.tool_box, box, gap, depth, number});
        // The nearest child goes on top, the others below in any order.
        const std::size_t top = stack_.size() - 1;
        if (top > first && stack_[top].gap > stack_[top - 1].gap)
        {
            std::swap(stack_[top], stack_[top - 1]);
        }
    }
}

} // namespace tactus
