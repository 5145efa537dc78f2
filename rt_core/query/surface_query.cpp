// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/surface_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/nearest_triangles.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

namespace tactus
{

namespace
{

constexpr float kInfiniteQuanta = std::numeric_limits<float>::infinity();

/// Search of one query: filters faces in single precision and quanta, and decides in double
/// precision and metres.
class SurfaceSearch
{
public:
    /// Prepares the search; `surface` is null if only the distance is requested.
    SurfaceSearch(const AbTree& tree, const Vec3& center_m, double reach_m, double band_m,
                  ProofShare share, ErrorCode tolerance, WalkBudget& budget,
                  LocalSurface* surface) noexcept
        : tree_(tree)
        , center_(center_m)
        , quantum_(static_cast<double>(tree.quantum_m()))
        , reach_(reach_m)
        , share_(share_of(share))
        , tolerance_(tolerance)
        , tolerance_m_(static_cast<double>(error_in_quanta(tolerance)) * quantum_)
        , budget_(budget)
        , probe_(make_probe(center_m, tree.quantum_m()))
        , reach_quanta_(surface == nullptr ? 0.0F : to_quanta(reach_m + tolerance_m_))
        , floor_(reach_quanta_)
        , limit_(to_quanta(band_m))
    {
        if (surface != nullptr)
        {
            nearest_triangles_.emplace(*surface);
        }
    }

    /// Runs the search. A first block gives a bound that is nearly final: the last nearest block
    /// or, after a jump, the block behind the nearest boxes. With it the order does not matter, and
    /// one pass visits all that is near.
    void run(QueryMemory& memory) noexcept
    {
        BlockBatch batch; // NOLINT(cppcoreguidelines-pro-type-member-init): filled to its count.
        batch.count = 0;
        if (tree_.is_block_in_use(memory.block))
        {
            known_.before = memory.block;
            test_alone(memory.block, batch);
        }
        if (known_.before == kNoNode || limit_ > kPoorLimit * memory.limit)
        {
            const std::uint32_t nearest = descend();
            if (nearest != kNoNode && nearest != known_.before)
            {
                known_.nearest = nearest;
                test_alone(nearest, batch);
            }
        }
        walk(batch);
        decide();
        memory.block = nearest_block_ == kNoNode ? memory.block : nearest_block_;
        memory.limit = limit_;
    }

    [[nodiscard]] DistanceAnswer answer() const noexcept
    {
        Findings found;
        found.exact_lower_m = exact_lower_;
        found.tolerated_lower_m = tolerated_lower_;
        found.upper_m = corner_ < kInfiniteQuanta ? std::min(upper_, to_metres(corner_)) : upper_;
        found.open_m = tree_.is_complete() ? unproven_ * quantum_ : 0.0;
        found.pruned_m = limit_ > floor_   ? to_metres(bound()) - tolerance_m_
                         : tolerance_ != 0 ? to_metres(floor_) - tolerance_m_
                                           : kInfinity;
        found.dropped_m = nearest_triangles_ ? nearest_triangles_->dropped_m() : kInfinity;
        DistanceAnswer answer = answer_from(found, reach_);
        answer.tool_point_m = center_;
        answer.tolerated_m = static_cast<double>(error_in_quanta(largest_tolerated_)) * quantum_;
        if (is_nearest_proven(found))
        {
            answer.nearest_face = nearest_face_;
            answer.nearest_point_m = nearest_.point;
            answer.nearest_feature = nearest_.feature;
        }
        return answer;
    }

private:
    /// Blocks with which the search begins; the walk leaves them out.
    struct KnownBlocks
    {
        std::uint32_t before{kNoNode};  ///< Block with the nearest face of the last query.
        std::uint32_t nearest{kNoNode}; ///< Block behind the nearest boxes.

        [[nodiscard]] bool has(std::uint32_t block) const noexcept
        {
            return block == before || block == nearest;
        }
    };
    struct Candidate
    {
        std::uint32_t block;
        std::uint32_t lane;
        float lower;
    };

    /// Distance in quanta beyond which nothing changes the answer. Never grows, so that parts left
    /// out stay beyond it. A surface within reach is measured even if the list only takes nearer
    /// faces.
    [[nodiscard]] float bound() const noexcept
    {
        return nearest_triangles_
                   ? std::max(floor_, std::min(limit_, std::max(reach_quanta_, share_ * limit_)))
                   : limit_;
    }

    void leave(float gap) noexcept { unproven_ = std::min(unproven_, static_cast<double>(gap)); }

    /// Returns the block reached by the nearest child of each node; kNoNode if the budget is spent.
    [[nodiscard]] std::uint32_t descend() noexcept
    {
        TreeRef ref = tree_.root();
        while (!ref.is_none() && !ref.is_block())
        {
            if (!budget_.take_node())
            {
                return kNoNode;
            }
            const AbNode& node = tree_.node(ref.index());
            alignas(32) std::array<float, kNodeChildren> gaps; // NOLINT: the kernel fills it.
            std::uint32_t children = AabbVolume::child_gaps(
                tree_.kernels(), node.volumes, probe_, node.mask, kInfiniteQuanta, gaps.data());
            float least = kInfiniteQuanta;
            for (ref = TreeRef{}; children != 0; children &= children - 1)
            {
                const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
                ref = gaps[child] < least ? node.children[child] : ref;
                least = std::min(least, gaps[child]);
            }
        }
        return ref.is_none() ? kNoNode : ref.index();
    }

    /// Visits the tree breadth first, so that no visit waits for the previous one. After half of
    /// the budget the nearest nodes come first, so that a spent budget leaves out far ones.
    void walk(BlockBatch& batch) noexcept
    {
        Frontier frontier; // NOLINT(cppcoreguidelines-pro-type-member-init): likewise.
        frontier.count = tree_.root().is_none() ? 0 : 1;
        frontier.refs[0] = tree_.root().value;
        frontier.gaps[0] = 0.0F;
        std::uint32_t next = 0;
        while (next < frontier.count && !budget_.is_spent)
        {
            const WalkItem item = take_next(frontier, next);
            const TreeRef ref = item.ref;
            const float gap = item.gap;
            if (gap > bound() || (ref.is_block() && known_.has(ref.index())))
            {
                continue;
            }
            if (!budget_.take_node() || (ref.is_block() && !test_block(ref.index())))
            {
                leave(gap);
                break;
            }
            if (!ref.is_block())
            {
                enter(tree_.node(ref.index()), frontier, batch);
            }
            if (batch.count > BlockBatch::kFull)
            {
                test_unknown(batch);
            }
        }
        test_unknown(batch);
        for (; next < frontier.count; ++next)
        {
            leave(frontier.gaps[next]);
        }
    }

    /// Returns the item at `next`, or, after half of the budget, the nearest of all from `next` on.
    /// If too many wait, returns the last.
    [[nodiscard]] WalkItem take_next(Frontier& frontier, std::uint32_t& next) const noexcept
    {
        const bool is_ordered = !budget_.is_half_spent();
        if (!is_ordered && next > 0)
        {
            forget_first(frontier, std::exchange(next, 0));
        }
        if (is_ordered && frontier.count < Frontier::kBroad)
        {
            const std::uint32_t at = next++;
            return {TreeRef{frontier.refs[at]}, frontier.gaps[at]};
        }
        TACTUS_ASSERT(frontier.count > 0);
        const std::uint32_t last = frontier.count - 1;
        std::uint32_t at = last;
        for (std::uint32_t i = 0; i < last && last < Frontier::kBroad - 1; ++i)
        {
            at = frontier.gaps[i] < frontier.gaps[at] ? i : at;
        }
        const WalkItem item{TreeRef{frontier.refs[at]}, frontier.gaps[at]};
        frontier.refs[at] = frontier.refs[last];
        frontier.gaps[at] = frontier.gaps[last];
        frontier.count = last;
        return item;
    }

    static void forget_first(Frontier& frontier, std::uint32_t gone) noexcept
    {
        frontier.count -= gone;
        std::copy_n(&frontier.refs[gone], frontier.count, &frontier.refs[0]);
        std::copy_n(&frontier.gaps[gone], frontier.count, &frontier.gaps[0]);
    }

    void enter(const AbNode& node, Frontier& frontier, BlockBatch& batch) noexcept
    {
        TACTUS_ASSERT(node.in_use);
        tree_.kernels().enter_node(node.volumes.low.front().data(), &node.children.front().value,
                                   probe_, node.mask, node.coarse, bound(), frontier, batch);
    }

    void test_alone(std::uint32_t index, BlockBatch& batch) noexcept
    {
        if (!budget_.take_node())
        {
            leave(0.0F);
        }
        else if (tree_.side(index).coarse != 0)
        {
            if (!test_block(index))
            {
                leave(0.0F);
            }
        }
        else
        {
            batch.blocks[0] = TreeRef::to_block(index).value;
            batch.gaps[0] = 0.0F;
            batch.count = 1;
            test_batch(batch);
        }
    }

    /// Tests all blocks of the batch except the known ones, and empties the batch.
    void test_unknown(BlockBatch& batch) noexcept
    {
        const std::uint32_t granted = budget_.take_nodes(batch.count);
        for (std::uint32_t i = granted; i < batch.count; ++i)
        {
            leave(batch.gaps[i]);
        }
        batch.count = granted;
        // The kernel leaves out one known block; after a jump there is a second one.
        const bool has_both = known_.before != kNoNode && known_.nearest != kNoNode;
        if (has_both)
        {
            leave_out(TreeRef::to_block(known_.before).value, batch);
        }
        const std::uint32_t known = known_.nearest != kNoNode ? known_.nearest : known_.before;
        tree_.kernels().sort_out(&tree_.block(0), probe_, TreeRef::to_block(known).value, bound(),
                                 batch);
        test_batch(batch);
    }

    static void leave_out(std::uint32_t block, BlockBatch& batch) noexcept
    {
        std::uint32_t left = 0;
        for (std::uint32_t i = 0; i < batch.count; ++i)
        {
            batch.blocks[left] = batch.blocks[i];
            batch.gaps[left] = batch.gaps[i];
            for (auto& axis : batch.toward)
            {
                axis[left] = axis[i];
            }
            left += batch.blocks[i] != block ? 1U : 0U;
        }
        batch.count = left;
    }

    void test_batch(BlockBatch& batch) noexcept
    {
        const std::uint32_t count = std::exchange(batch.count, 0);
        for (; batch.count < count; ++batch.count)
        {
            const TreeRef ref{batch.blocks[batch.count]};
            if (!budget_.take_triangles(face_count(tree_.block(ref.index()))))
            {
                break;
            }
        }
        for (std::uint32_t i = batch.count; i < count; ++i)
        {
            leave(batch.gaps[i]);
        }
        tree_.kernels().test_blocks(&tree_.block(0), probe_, floor_, limit_, batch);
        for (std::uint32_t i = 0; i < batch.count; ++i)
        {
            const std::uint32_t block = TreeRef{batch.blocks[i]}.index();
            for (std::uint32_t near = batch.near[i]; near != 0; near &= near - 1)
            {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
                const float lower_sq = std::max(batch.lower_sq[i][lane], 0.0F);
                add_surface({block, lane, std::sqrt(lower_sq) - probe_.slack}, 0);
            }
        }
        batch.count = 0;
    }

    /// Tests the faces of a block, which may be coarse. False if the budget is spent.
    [[nodiscard]] bool test_block(std::uint32_t index) noexcept
    {
        const BlockGeometry& block = tree_.block(index);
        if (!budget_.take_triangles(face_count(block)))
        {
            return false;
        }
        TACTUS_ASSERT(tree_.side(index).in_use);
        const std::uint32_t coarse = lanes_above(tree_.side(index), tolerance_);
        const float limit_before = limit_;
        FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        std::uint32_t near = tree_.kernels().face_bounds(
            block.coordinates.front().data(), block.corners.front().data(), probe_, block.faces,
            block.faces & ~coarse, floor_, limit_, bounds);
        add_coarse(index, coarse, bounds);
        near &= ~coarse;
        if (limit_ < limit_before)
        {
            nearest_block_ = index;
        }
        for (; near != 0; near &= near - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
            add_surface({index, lane, bounds.lower[lane]}, tree_.side(index).errors[lane]);
        }
        return true;
    }

    [[nodiscard]] float to_quanta(double metres) const noexcept
    {
        return metres < kFarQuanta * quantum_ ? round_up_to_float(metres / quantum_)
                                              : kInfiniteQuanta;
    }
    [[nodiscard]] double to_metres(float quanta) const noexcept
    {
        return static_cast<double>(quanta) * quantum_;
    }

    void add_coarse(std::uint32_t index, std::uint32_t lanes, const FaceBounds& bounds) noexcept
    {
        const BlockSide& side = tree_.side(index);
        for (; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const float error = error_in_quanta(side.errors[lane]);
            if ((side.outdated >> lane & 1U) == 0)
            {
                corner_ = std::min(corner_, bounds.corner[lane]);
                limit_ = std::min(limit_, corner_);
            }
            // The rounding of this difference is less than the kernel's margin.
            const float lower = bounds.lower[lane] - error;
            if (static_cast<double>(lower) < unproven_)
            {
                unproven_ = lower < bound() ? std::min(unproven_, coarse_gap(index, lane, error))
                                            : static_cast<double>(lower);
            }
        }
    }

    [[nodiscard]] ClosestPoint closest_point(std::uint32_t block, std::uint32_t lane) const noexcept
    {
        const Triangle triangle = to_triangle(block_triangle(tree_.block(block), lane));
        SeenTriangle seen; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        tree_.kernels().see_triangle(center_.data(), triangle[0].data(), seen);
        return closest_point_seen(center_, triangle, seen);
    }

    /// Gap of a coarse face in double precision: the margin of single precision is wide on thin
    /// faces and must not leave an answer open.
    [[nodiscard]] double coarse_gap(std::uint32_t index, std::uint32_t lane,
                                    float error) const noexcept
    {
        const ClosestPoint closest = closest_point(index, lane);
        return (std::sqrt(closest.distance_sq) - closest.distance_error) / quantum_ -
               static_cast<double>(error);
    }

    /// Adds a face that counts as the surface: its error is 0 or within the tolerance.
    void add_surface(const Candidate& candidate, ErrorCode error) noexcept
    {
        if (nearest_triangles_ && candidate.lower <= floor_)
        {
            largest_tolerated_ = std::max(largest_tolerated_, error);
            const double lower_m =
                std::max(0.0, to_metres(candidate.lower - error_in_quanta(error)));
            if (LocalTriangle* const place = nearest_triangles_->add(lower_m))
            {
                *place = {tree_.side(candidate.block).prims[candidate.lane],
                          block_triangle(tree_.block(candidate.block), candidate.lane)};
            }
            if (nearest_triangles_->dropped_m() < kInfinity)
            {
                floor_ =
                    std::min(floor_, to_quanta(nearest_triangles_->dropped_m() + tolerance_m_));
            }
        }
        if (is_too_far(candidate))
        {
            return;
        }
        if (!candidates_.try_push_back(candidate))
        {
            decide();
            candidates_.push_back(candidate);
        }
    }

    /// Finds, in double precision, the nearest of the faces that single precision cannot tell
    /// apart. The lowest face id decides between equally near faces, in any order of traversal.
    void decide() noexcept
    {
        for (const Candidate& candidate : candidates_)
        {
            if (is_too_far(candidate))
            {
                continue;
            }
            const ClosestPoint closest = closest_point(candidate.block, candidate.lane);
            const double distance = std::sqrt(closest.distance_sq);
            const double lower = distance - closest.distance_error;
            if (const ErrorCode error = error_of(candidate); error == 0)
            {
                exact_lower_ = std::min(exact_lower_, lower);
                upper_ = std::min(upper_, distance + closest.distance_error);
            }
            else
            {
                tolerated_lower_ =
                    std::min(tolerated_lower_,
                             lower - static_cast<double>(error_in_quanta(error)) * quantum_);
                largest_tolerated_ = std::max(largest_tolerated_, error);
                bound_by_corners(candidate);
            }
            const FaceId face = tree_.face_of(tree_.side(candidate.block).prims[candidate.lane]);
            if (nearest_face_.is_none() || closest.distance_sq < nearest_.distance_sq ||
                (closest.distance_sq == nearest_.distance_sq && face < nearest_face_))
            {
                nearest_ = closest;
                nearest_face_ = face;
                nearest_block_ = candidate.block;
            }
        }
        candidates_.clear();
    }

    [[nodiscard]] ErrorCode error_of(const Candidate& candidate) const noexcept
    {
        return tree_.side(candidate.block).errors[candidate.lane];
    }
    /// True if neither the face nor the surface that it stands for can be the nearest.
    [[nodiscard]] bool is_too_far(const Candidate& candidate) const noexcept
    {
        return candidate.lower > limit_ + error_in_quanta(tolerance_);
    }
    /// Bounds the distance by the corners of an inexact face, which are original vertices.
    void bound_by_corners(const Candidate& candidate) noexcept
    {
        for (const Vec3& corner :
             to_triangle(block_triangle(tree_.block(candidate.block), candidate.lane)))
        {
            upper_ = std::min(upper_, (corner - center_).norm() * kRootRoundedUp);
        }
    }

    static constexpr std::size_t kCandidates = 64;
    /// Ratio of bound to last answer above which the remembered block counts as no longer near the
    /// surface.
    static constexpr float kPoorLimit = 2.0F;

    const AbTree& tree_;
    Vec3 center_;
    double quantum_;
    double reach_;
    float share_;         ///< Share of limit_ within which faces are tested if none is in reach.
    ErrorCode tolerance_; ///< Largest error of faces that count as the surface.
    double tolerance_m_;
    WalkBudget& budget_;
    /// List of the collected triangles; none if only the distance is requested.
    std::optional<NearestTriangles> nearest_triangles_;
    KernelProbe probe_;
    float reach_quanta_; ///< Reach in quanta, rounded up; 0 if nothing is collected.
    /// Distance within which faces are always tested, in quanta: the reach, lowered to the distance
    /// of dropped faces.
    float floor_;
    /// Upper bound on the distance to the surface, or the band if that is less, in quanta.
    float limit_;
    /// Upper bound from the nearest corner of a coarse face, in quanta.
    float corner_{kInfiniteQuanta};
    /// Lower bound on the distance of inexact and unvisited parts, in quanta.
    double unproven_{kInfinity};
    StaticVector<Candidate, kCandidates> candidates_;
    double exact_lower_{kInfinity};
    /// Lower bound on the distance of surface that coarse faces within the tolerance stand for.
    double tolerated_lower_{kInfinity};
    ErrorCode largest_tolerated_{0};
    double upper_{kInfinity};
    ClosestPoint nearest_;
    FaceId nearest_face_{};
    std::uint32_t nearest_block_{kNoNode};
    KnownBlocks known_;
};

/// Answer for a point beyond the range of single precision: the tree's box bounds the distance.
DistanceAnswer answer_from_afar(const AbTree& tree, const Vec3& center_m, double reach_m) noexcept
{
    const Aabb box = tree.box();
    DistanceAnswer answer;
    double near_sq = 0.0;
    double far_sq = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double at = center_m[static_cast<Eigen::Index>(axis)];
        const double below = static_cast<double>(box.low[axis]) - at;
        const double above = at - static_cast<double>(box.high[axis]);
        const double gap = std::max({below, above, 0.0});
        const double span = std::max(std::abs(below), std::abs(above));
        near_sq += gap * gap;
        far_sq += span * span;
    }
    answer.lower_m = tree.is_complete() ? std::sqrt(near_sq) * kRootRoundedDown : 0.0;
    answer.upper_m = std::sqrt(far_sq) * kRootRoundedUp;
    answer.kind = answer.lower_m > reach_m ? AnswerKind::separated : AnswerKind::bounded;
    answer.tool_point_m = center_m;
    return answer;
}

/// Runs one query. Not inlined, so that a warm-up runs the same machine code as the query.
[[gnu::noinline]] DistanceAnswer search(const AbTree& tree, const Vec3& center_m, double reach_m,
                                        double band_m, ProofShare share, ErrorCode tolerance,
                                        QueryMemory& memory, WalkBudget& budget,
                                        LocalSurface* surface) noexcept
{
    if (is_beyond_kernels(center_m, tree.quantum_m()))
    {
        return answer_from_afar(tree, center_m, reach_m);
    }
    SurfaceSearch search(tree, center_m, reach_m, band_m, share, tolerance, budget, surface);
    search.run(memory);
    return search.answer();
}

} // namespace

void gather_surface(const AbTree& tree, const Vec3& center_m, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface, ProofShare share,
                    ErrorCode tolerance) noexcept
{
    surface.center_m = center_m;
    surface.count = 0;
    surface.truncated = false;
    surface.answer =
        search(tree, center_m, reach_m, kInfinity, share, tolerance, memory, budget, &surface);
    surface.is_cut = surface.truncated || budget.is_spent;
}

DistanceAnswer query_distance(const AbTree& tree, const Vec3& center_m, double band_m,
                              QueryMemory& memory, WalkBudget& budget) noexcept
{
    return search(tree, center_m, 0.0, band_m, ProofShare::all, 0, memory, budget, nullptr);
}

} // namespace tactus
