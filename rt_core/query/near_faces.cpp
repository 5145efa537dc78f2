// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/near_faces.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/query/unfinished_search.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

namespace
{

/// Reference that stands for the loose faces in a walk, which then has no other block of the tool.
constexpr TreeRef kLoose = TreeRef::to_block(0);

} // namespace

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): distances are written before each look.
NearFaces::NearFaces(const AbTree& own, OtherSurface& other, ErrorCode tolerance) noexcept
    : own_(own)
    , other_(other)
    , views_(own, other.tree(), other.placement())
    , placed_(own, other.tree(), other.placement(), views_, tolerance)
    , quanta_per_m_(views_.scale() / static_cast<double>(other.tree().quantum_m()))
{
}

void NearFaces::find(double bound_m, std::uint32_t enough, UnfinishedSearch* unfinished) noexcept
{
    TACTUS_ASSERT(enough > 0);
    enough_ = enough;
    search(bound_m, {own_.root(), own_.box(), true}, nullptr, unfinished);
}

void NearFaces::find(const LooseFaces& faces, double bound_m) noexcept
{
    TACTUS_ASSERT(faces.lanes != 0);
    double largest_m = 0.0;
    for (std::uint32_t left = faces.lanes; left != 0; left &= left - 1)
    {
        largest_m =
            std::max(largest_m, faces.errors_m[static_cast<std::size_t>(std::countr_zero(left))]);
    }
    const Aabb box =
        AabbVolume::of_vertices(own_.kernels(), faces.geometry.coordinates.front().data(),
                                faces.geometry.vertices)
            .inflated(round_up_to_float(largest_m));
    if (!views_.is_beyond_kernels())
    {
        placed_.put_loose(faces.geometry, faces.lanes, faces.errors_m);
    }
    search(bound_m, {kLoose, box, false}, &faces, nullptr);
}

void NearFaces::search(double bound_m, const PairWalk::Start& start, const LooseFaces* loose,
                       UnfinishedSearch* unfinished) noexcept
{
    TACTUS_ASSERT(bound_m >= 0.0);
    const double bound = bound_m * quanta_per_m_ * kRoundedUp;
    bound_ = bound < kFarQuanta ? round_up_to_float(bound) : kNothingLeft;
    if (!other_.tree().is_complete())
    {
        leave(0.0F); // Faces that did not fit into the other tree may be anywhere.
    }
    if (views_.is_beyond_kernels())
    {
        const double gap_m = other_.lower_bound_m(sphere_round(start.box), bound_m);
        leave(round_down_to_float(gap_m * quanta_per_m_ / kRoundedUp));
        return;
    }
    other_.budget().spend(WorkCost::walk);
    PairWalk walk(own_, other_.tree(), views_, other_.budget(), start);
    if (unfinished != nullptr)
    {
        resume(*unfinished, walk);
    }
    PairWalk::Sought sought{bound_};
    bool is_done = true; // False if the last pair of blocks was not tested completely.
    while (!is_full())
    {
        const PairWalk::Item* near = walk.next_blocks(sought);
        if (near == nullptr)
        {
            break;
        }
        const PlacedBlock& own =
            loose != nullptr ? placed_.loose() : placed_.get(near->tool.index());
        const std::uint32_t lanes = open_lanes(own);
        if (lanes == 0)
        {
            sought.settled = near->tool;
        }
        else if (!try_test(*near, own, lanes))
        {
            leave(near->gap);
            is_done = false;
            break;
        }
    }
    measure();
    if (unfinished != nullptr && !is_full())
    {
        keep(walk, is_done, *unfinished);
    }
    leave(walk.end());
}

/// Continues an unfinished search, if both trees are unchanged. Its proven distances shrink by the
/// other surface's motion and by the rounding of its new place.
void NearFaces::resume(UnfinishedSearch& unfinished, PairWalk& walk) noexcept
{
    if (!unfinished.left.empty() && unfinished.own_change == own_.last_change() &&
        unfinished.other_change == other_.tree().last_change())
    {
        const double travel = unfinished.moved_m * quanta_per_m_ * kRoundedUp +
                              2.0 * static_cast<double>(views_.slack());
        const auto now = [&](double before_m)
        { return round_down_to_float(before_m * quanta_per_m_ / kRoundedUp - travel); };
        walk.resume(unfinished.left, travel);
        bound_ = std::min(bound_, std::max(now(unfinished.bound_m), 0.0F));
        leave(std::min(bound_, now(unfinished.nearest_m)));
    }
    unfinished.left.clear();
}

void NearFaces::keep(const PairWalk& walk, bool is_done,
                     UnfinishedSearch& unfinished) const noexcept
{
    float nearest = std::min(rest_, bound_);
    for (const Block& block : blocks_)
    {
        for (std::uint32_t left = block.lanes; left != 0; left &= left - 1)
        {
            nearest =
                std::min(nearest, block.gaps[static_cast<std::size_t>(std::countr_zero(left))]);
        }
    }
    walk.keep_left(is_done, unfinished.left);
    unfinished.own_change = own_.last_change();
    unfinished.other_change = other_.tree().last_change();
    unfinished.bound_m = to_m(bound_);
    unfinished.nearest_m = to_m(nearest);
    unfinished.moved_m = 0.0;
}

/// Tests the faces in `lanes` against a block of the other tree; false if the budget is spent
/// before the end.
bool NearFaces::try_test(const PairWalk::Item& item, const PlacedBlock& own,
                         std::uint32_t lanes) noexcept
{
    WalkBudget& budget = other_.budget();
    const Kernels& kernels = own_.kernels();
    const BlockGeometry& block = other_.tree().block(item.object.index());
    const BlockSide& side = other_.tree().side(item.object.index());
    const Aabb& box = item.object_box;
    const std::array<float, 6> ends{box.low[0],  box.low[1],  box.low[2],
                                    box.high[0], box.high[1], box.high[2]};
    if (!budget.take_triangles(count_lanes(lanes), WorkCost::coarse_row))
    {
        return false;
    }
    float gap = 0.0F;
    lanes =
        kernels.near_rows(own.rows, ends.data(), own.box.center, lanes, bound_, own.slack(), gap);
    if (lanes == 0)
    {
        return true;
    }
    budget.spend(WorkCost::near_block);
    // The other's box includes its faces' errors, its block does not.
    const float bound = (bound_ + largest_error_quanta(side)) * kSumRoundedUp;
    VertexRows rows; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
    const std::uint8_t* corners = block.corners.front().data();
    const std::uint32_t others =
        kernels.near_block(block.coordinates.front().data(), corners, own.box, block.faces,
                           (bound + own.largest_error(lanes)) * kSumRoundedUp, rows);
    std::array<std::uint32_t, kBlockFaces> near; // NOLINT: the kernel fills what is read.
    kernels.near_pairs(rows, corners, others, own.rows, lanes, bound, own.slack(), nullptr,
                       near.data());
    FacePair pair{own.index, item.object.index()};
    for (; lanes != 0; lanes &= lanes - 1)
    {
        pair.tool_lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
        for (std::uint32_t left = near[pair.tool_lane]; left != 0; left &= left - 1)
        {
            if (!budget.take_triangles(1, WorkCost::face_pair))
            {
                return false;
            }
            pair.lane = static_cast<std::uint32_t>(std::countr_zero(left));
            errors_[queue_.size()] =
                (own.rows.error[pair.tool_lane] + error_in_quanta(side.errors[pair.lane])) *
                kSumRoundedUp;
            queue_.add(pair, own, block, rows, views_.slack());
            if (queue_.is_full())
            {
                measure();
                if (may_meet(own.index, pair.tool_lane))
                {
                    break;
                }
            }
        }
    }
    return true;
}

/// Lanes of a block's coarse faces, except those within the tolerance and those known to be
/// possibly meeting: for the latter no nearer face is sought.
std::uint32_t NearFaces::open_lanes(const PlacedBlock& own) noexcept
{
    std::uint32_t lanes = own.open;
    const Block* known = find_block(own.index);
    for (std::uint32_t left = known != nullptr ? known->lanes : 0; left != 0; left &= left - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
        lanes &= known->gaps[lane] <= 0.0F ? ~(1U << lane) : ~0U;
    }
    return lanes;
}

bool NearFaces::may_meet(std::uint32_t block, std::uint32_t lane) noexcept
{
    const Block* known = find_block(block);
    return known != nullptr && (known->lanes >> lane & 1U) != 0 && known->gaps[lane] <= 0.0F;
}

void NearFaces::measure() noexcept
{
    own_.kernels().pair_distances(queue_.rows(), queue_.size(), distances_);
    for (std::uint32_t lane = 0; lane < queue_.size(); ++lane)
    {
        const double gap =
            static_cast<double>(distances_.lower[lane]) - static_cast<double>(errors_[lane]);
        if (gap <= static_cast<double>(bound_))
        {
            take(queue_[lane], round_down_to_float(gap));
        }
    }
    queue_.clear();
}

/// Records that the own face of a pair may be as near as `lower`, in quanta.
void NearFaces::take(const FacePair& pair, float lower) noexcept
{
    Block* block = find_block(pair.tool_block);
    if (block == nullptr && blocks_.full())
    {
        leave(lower);
        return;
    }
    if (block == nullptr)
    {
        last_ = static_cast<std::uint32_t>(blocks_.size());
        blocks_.push_back({pair.tool_block, 0, {}});
        block = &blocks_[last_];
    }
    const std::uint32_t bit = 1U << pair.tool_lane;
    float& kept = block->gaps[pair.tool_lane];
    const bool is_known = (block->lanes & bit) != 0;
    kept = is_known ? std::min(kept, lower) : lower;
    found_ += is_known ? 0U : 1U;
    block->lanes |= bit;
}

/// Finds the entry of a block; null if none of its faces was near so far.
NearFaces::Block* NearFaces::find_block(std::uint32_t index) noexcept
{
    if (last_ < blocks_.size() && blocks_[last_].index == index)
    {
        return &blocks_[last_];
    }
    const auto* const found = std::ranges::find(blocks_, index, &Block::index);
    if (found == blocks_.end())
    {
        return nullptr;
    }
    last_ = static_cast<std::uint32_t>(found - blocks_.begin());
    return &blocks_[last_];
}

double NearFaces::to_m(float quanta) const noexcept
{
    const double nearest_m = static_cast<double>(quanta) / quanta_per_m_;
    return quanta > 0.0F ? nearest_m / kRoundedUp : nearest_m * kRoundedUp;
}

} // namespace tactus
