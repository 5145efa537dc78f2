// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/core_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/nearest_triangles.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <limits>

namespace tactus
{

namespace
{

/// One query. Kernels bound distances from the core's centre; its ball turns them into bounds from
/// the core.
class CoreSearch
{
public:
    CoreSearch(const AbTree& tree, const PlacedCore& core, double reach_m, ProofShare share,
               WalkBudget& budget, LocalSurface& surface) noexcept
        : tree_(tree)
        , core_(core)
        , quantum_(static_cast<double>(tree.quantum_m()))
        , reach_(reach_m)
        , share_(static_cast<double>(share_of(share)))
        , budget_(budget)
        , probe_(make_probe(core.center(), tree.quantum_m()))
        , triangles_(surface)
    {
    }

    void run(QueryMemory& memory) noexcept
    {
        search_blocks(tree_, probe_, budget_, memory, *this);
        memory.block = nearest_block_ == kNoNode ? memory.block : nearest_block_;
    }

    [[nodiscard]] float bound() const noexcept
    {
        const double quanta = (core_.radius() + worth_m()) / quantum_;
        return quanta < kFarQuanta ? round_up_to_float(quanta)
                                   : std::numeric_limits<float>::infinity();
    }

    void leave(float gap) noexcept { open_ = std::min(open_, from_core(gap)); }

    /// False when the budget is spent.
    [[nodiscard]] bool test_block(std::uint32_t index) noexcept
    {
        const BlockGeometry& block = tree_.block(index);
        if (!budget_.take_triangles(face_count(block)))
        {
            open_ = 0.0; // Its parent's bound may have gone with it.
            return false;
        }
        const BlockSide& side = tree_.side(index);
        TACTUS_ASSERT(side.in_use);
        FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        bound_faces(tree_.kernels(), block, block.faces, probe_, bounds);
        for (std::uint32_t lanes = block.faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const double error = static_cast<double>(error_in_quanta(side.errors[lane])) * quantum_;
            test_face({index, lane, (side.coarse >> lane & 1U) != 0, error},
                      from_core(bounds.lower[lane]) - error);
        }
        return true;
    }

    [[nodiscard]] DistanceAnswer answer() const noexcept
    {
        Findings found;
        found.exact_lower_m = exact_lower_;
        found.upper_m = upper_;
        found.open_m = tree_.is_complete() ? open_ : 0.0;
        found.pruned_m = upper_ > reach_ ? worth_m() : kInfinity;
        found.dropped_m = triangles_.dropped_m();
        DistanceAnswer answer = answer_from(found, reach_);
        answer.tool_point_m = core_.center();
        if (is_nearest_proven(found))
        {
            answer.tool_point_m = nearest_.on_shape;
            answer.nearest_face = nearest_face_;
            answer.nearest_point_m = nearest_.on_triangle;
            answer.nearest_feature = nearest_.feature;
        }
        return answer;
    }

private:
    struct Face
    {
        std::uint32_t block;
        std::uint32_t lane;
        bool is_coarse;
        double error_m;
    };

    /// What is farther changes nothing. Never grows: what was left out stays farther.
    [[nodiscard]] double worth_m() const noexcept { return std::max(reach_, share_ * upper_); }

    /// Both roundings are relative and far below the margin of the kernels.
    [[nodiscard]] double from_core(float quanta) const noexcept
    {
        return static_cast<double>(quanta) * quantum_ - core_.radius();
    }

    void test_face(const Face& face, double lower_m) noexcept
    {
        const Triangle triangle = to_triangle(block_triangle(tree_.block(face.block), face.lane));
        double lower = lower_m;
        if (lower <= worth_m())
        {
            lower = std::max(lower, core_.lower_bound(triangle) - face.error_m);
        }
        if (lower > worth_m())
        {
            open_ = face.is_coarse ? std::min(open_, lower) : open_;
            return;
        }
        const ClosestPoints closest = core_.closest(triangle);
        if (face.is_coarse)
        {
            open_ = std::min(open_, closest.distance - closest.distance_error - face.error_m);
            bound_by_corners(triangle);
            return;
        }
        add_exact(face, closest);
    }

    void add_exact(const Face& face, const ClosestPoints& closest) noexcept
    {
        const double lower = std::max(0.0, closest.distance - closest.distance_error);
        const PrimId prim = tree_.side(face.block).prims[face.lane];
        if (lower <= reach_)
        {
            triangles_.add({prim, block_triangle(tree_.block(face.block), face.lane)}, lower);
        }
        exact_lower_ = std::min(exact_lower_, lower);
        upper_ = std::min(upper_, closest.distance + closest.distance_error);
        const FaceId id = tree_.face_of(prim);
        if (nearest_face_.is_none() || closest.distance < nearest_.distance ||
            (closest.distance == nearest_.distance && id < nearest_face_))
        {
            nearest_ = closest;
            nearest_face_ = id;
            nearest_block_ = face.block;
        }
    }

    /// The corners of a coarse face are original vertices.
    void bound_by_corners(const Triangle& triangle) noexcept
    {
        for (const Vec3& corner : triangle)
        {
            const Triangle point{corner, corner, corner};
            if (core_.lower_bound(point) < upper_)
            {
                const ClosestPoints closest = core_.closest(point);
                upper_ = std::min(upper_, closest.distance + closest.distance_error);
            }
        }
    }

    const AbTree& tree_;
    const PlacedCore& core_;
    double quantum_;
    double reach_;
    double share_; ///< Of the best distance: what is farther is not looked at.
    WalkBudget& budget_;
    KernelProbe probe_;
    NearestTriangles triangles_;
    double open_{kInfinity};        ///< What is not known exactly is at least this far away.
    double exact_lower_{kInfinity}; ///< Exact faces are;
    double upper_{kInfinity};       ///< something of the surface is at most.
    ClosestPoints nearest_;
    FaceId nearest_face_{};
    std::uint32_t nearest_block_{kNoNode};
};

} // namespace

void gather_surface(const AbTree& tree, const PlacedCore& core, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface, ProofShare share) noexcept
{
    if (core.is_point())
    {
        gather_surface(tree, core.center(), reach_m, memory, budget, surface, share);
        return;
    }
    if (is_beyond_kernels(core.center(), tree.quantum_m()))
    {
        gather_surface(tree, core.center(), reach_m, memory, budget, surface, share);
        DistanceAnswer& answer = surface.answer;
        answer.lower_m = std::max(0.0, answer.lower_m - core.radius());
        answer.kind = answer.lower_m > reach_m ? AnswerKind::decided : AnswerKind::bracket;
        return;
    }
    TACTUS_ASSERT(!core.is_mesh());
    surface.center_m = core.center();
    CoreSearch search(tree, core, reach_m, share, budget, surface);
    search.run(memory);
    surface.answer = search.answer();
}

} // namespace tactus
