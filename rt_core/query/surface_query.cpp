// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/surface_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/nearest_triangles.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus
{

namespace
{

constexpr float kInfiniteQuanta = std::numeric_limits<float>::infinity();

/// One query: filters in single precision and quanta, decides in double precision and metres.
class SurfaceSearch
{
public:
    /// `surface` is null when only the distance is asked for; then nothing is collected.
    SurfaceSearch(const AbTree& tree, const Vec3& center_m, double reach_m, double band_m,
                  WalkBudget& budget, LocalSurface* surface) noexcept
        : tree_(tree)
        , center_(center_m)
        , quantum_(static_cast<double>(tree.quantum_m()))
        , reach_(reach_m)
        , budget_(budget)
        , probe_(make_probe(center_m, tree.quantum_m()))
        , floor_(surface == nullptr ? 0.0F : to_quanta(reach_m))
        , limit_(to_quanta(band_m))
    {
        if (surface != nullptr)
        {
            nearest_triangles_.emplace(*surface);
        }
    }

    void run(QueryMemory& memory) noexcept
    {
        search_blocks(tree_, probe_, budget_, memory, *this);
        decide();
        memory.block = nearest_block_ == kNoNode ? memory.block : nearest_block_;
    }

    /// Beyond this nothing changes the answer. Never grows: what was left out stays beyond it.
    [[nodiscard]] float bound() const noexcept
    {
        return nearest_triangles_ ? std::max(floor_, kProofShare * limit_) : limit_;
    }

    /// False when the budget is spent.
    [[nodiscard]] bool test_block(std::uint32_t index) noexcept
    {
        const BlockGeometry& block = tree_.block(index);
        if (!budget_.take_triangles(face_count(block)))
        {
            unproven_ = 0.0; // Its parent's bound may have gone with it.
            return false;
        }
        TACTUS_ASSERT(tree_.side(index).in_use);
        const std::uint32_t coarse = tree_.side(index).coarse;
        const float limit_before = limit_;
        FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        std::uint32_t near = tree_.kernels().face_bounds(
            block.coordinates.front().data(), block.corners.front().data(), probe_, block.faces,
            block.faces & ~coarse, floor_, limit_, bounds);
        if (coarse != 0)
        {
            add_coarse(index, coarse, bounds);
            near &= ~coarse;
        }
        if (limit_ < limit_before)
        {
            nearest_block_ = index;
        }
        for (; near != 0; near &= near - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
            add_exact({index, lane, bounds.lower[lane]});
        }
        return true;
    }

    void leave(float gap) noexcept { unproven_ = std::min(unproven_, static_cast<double>(gap)); }

    [[nodiscard]] DistanceAnswer answer() const noexcept
    {
        Findings found;
        found.exact_lower_m = exact_lower_;
        found.upper_m = corner_ < kInfiniteQuanta ? std::min(upper_, to_metres(corner_)) : upper_;
        found.open_m = tree_.is_complete() ? unproven_ * quantum_ : 0.0;
        found.pruned_m = limit_ > floor_ ? to_metres(bound()) : kInfinity;
        found.dropped_m = nearest_triangles_ ? nearest_triangles_->dropped_m() : kInfinity;
        DistanceAnswer answer = answer_from(found, reach_);
        answer.tool_point_m = center_;
        if (is_nearest_proven(found))
        {
            answer.nearest_face = nearest_face_;
            answer.nearest_point_m = nearest_.point;
            answer.nearest_feature = nearest_.feature;
        }
        return answer;
    }

private:
    struct Candidate
    {
        std::uint32_t block;
        std::uint32_t lane;
        float lower;
    };

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
            corner_ = std::min(corner_, bounds.corner[lane]);
            limit_ = std::min(limit_, corner_);
            // Rounded towards zero by less than the kernel's margin is wide.
            const float lower = bounds.lower[lane] - error;
            if (static_cast<double>(lower) < unproven_)
            {
                unproven_ = lower < bound() ? std::min(unproven_, coarse_gap(index, lane, error))
                                            : static_cast<double>(lower);
            }
        }
    }

    /// In double precision: the margin of single precision is wide on thin faces, and an answer
    /// must not be open for it.
    [[nodiscard]] double coarse_gap(std::uint32_t index, std::uint32_t lane,
                                    float error) const noexcept
    {
        const ClosestPoint closest = closest_point_on_triangle(
            center_, to_triangle(block_triangle(tree_.block(index), lane)));
        return (std::sqrt(closest.distance_sq) - closest.distance_error) / quantum_ -
               static_cast<double>(error);
    }

    void add_exact(const Candidate& candidate) noexcept
    {
        if (nearest_triangles_ && candidate.lower <= floor_)
        {
            nearest_triangles_->add({tree_.side(candidate.block).prims[candidate.lane],
                                     block_triangle(tree_.block(candidate.block), candidate.lane)},
                                    std::max(0.0, to_metres(candidate.lower)));
        }
        if (candidate.lower > limit_)
        {
            return;
        }
        if (!candidates_.try_push_back(candidate))
        {
            decide();
            candidates_.push_back(candidate);
        }
    }

    /// In double precision: the nearest of the faces that single precision cannot tell apart. Ties
    /// go to the lowest face id, whatever the order of traversal.
    void decide() noexcept
    {
        for (const Candidate& candidate : candidates_)
        {
            if (candidate.lower > limit_)
            {
                continue;
            }
            const Triangle triangle =
                to_triangle(block_triangle(tree_.block(candidate.block), candidate.lane));
            const ClosestPoint closest = closest_point_on_triangle(center_, triangle);
            const double distance = std::sqrt(closest.distance_sq);
            exact_lower_ = std::min(exact_lower_, distance - closest.distance_error);
            upper_ = std::min(upper_, distance + closest.distance_error);
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

    static constexpr std::size_t kCandidates = 64;

    const AbTree& tree_;
    Vec3 center_;
    double quantum_;
    double reach_;
    WalkBudget& budget_;
    std::optional<NearestTriangles> nearest_triangles_; ///< None when nothing is collected.
    KernelProbe probe_;
    float floor_; ///< Faces this near are looked at whatever else is found; in quanta, as are:
    float limit_; ///< something of the surface is not farther than this, or the band;
    float corner_{kInfiniteQuanta}; ///< the nearest corner of a coarse face;
    double unproven_{kInfinity};    ///< what is not known exactly is at least this far away.
    StaticVector<Candidate, kCandidates> candidates_;
    double exact_lower_{kInfinity};
    double upper_{kInfinity};
    ClosestPoint nearest_;
    FaceId nearest_face_{};
    std::uint32_t nearest_block_{kNoNode};
};

/// From where single precision does not reach: the box of everything says how far it is.
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
    answer.kind = answer.lower_m > reach_m ? AnswerKind::decided : AnswerKind::bracket;
    answer.tool_point_m = center_m;
    return answer;
}

/// Not inlined: a rehearsal must run the same machine code as the query.
[[gnu::noinline]] DistanceAnswer search(const AbTree& tree, const Vec3& center_m, double reach_m,
                                        double band_m, QueryMemory& memory, WalkBudget& budget,
                                        LocalSurface* surface) noexcept
{
    if (is_beyond_kernels(center_m, tree.quantum_m()))
    {
        return answer_from_afar(tree, center_m, reach_m);
    }
    SurfaceSearch search(tree, center_m, reach_m, band_m, budget, surface);
    search.run(memory);
    return search.answer();
}

} // namespace

void gather_surface(const AbTree& tree, const Vec3& center_m, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface) noexcept
{
    surface.center_m = center_m;
    surface.count = 0;
    surface.truncated = false;
    surface.answer = search(tree, center_m, reach_m, kInfinity, memory, budget, &surface);
}

DistanceAnswer query_distance(const AbTree& tree, const Vec3& center_m, double band_m,
                              QueryMemory& memory, WalkBudget& budget) noexcept
{
    return search(tree, center_m, 0.0, band_m, memory, budget, nullptr);
}

} // namespace tactus
