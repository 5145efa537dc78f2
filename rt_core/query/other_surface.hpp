// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/node.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/shapes.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/query/mesh_placement.hpp"
#include "rt_core/query/query_memory.hpp"
#include "rt_core/query/walk_budget.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

class AbTree;

/// Surface of another model as seen from a model's frame, for refinement near an object and for
/// queries with a mesh tool. Lengths are in the viewing model's frame. Valid for one frame. The
/// budget bounds all work of this object. Haptic thread.
class OtherSurface
{
public:
    OtherSurface() noexcept = default;
    /// `there` places the viewing model's frame in that of `other`, whose boxes must be refitted
    /// (AbTree::refit) at each query.
    OtherSurface(const AbTree& other, MeshPlacement there, const WalkBudget& budget) noexcept
        : other_(&other), there_(std::move(there)), budget_(budget)
    {
    }

    /// Lower bound on the distance of the surface from any point of the sphere; it may be negative,
    /// down to minus the radius. Bounds of `enough_m` and more need not be tight. Computed in
    /// single precision.
    [[nodiscard]] double lower_bound_m(const Sphere& sphere,
                                       double enough_m) noexcept TACTUS_NONBLOCKING;
    /// Upper bound on the distance of some point in the sphere from the other model's original
    /// surface. The caller must ensure that the sphere holds a part of the measured shape.
    [[nodiscard]] double upper_bound_m(const Sphere& sphere) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const AbTree& tree() const noexcept { return *other_; }
    /// Placement of the viewing model's frame in the other model's.
    [[nodiscard]] const MeshPlacement& placement() const noexcept { return there_; }
    [[nodiscard]] WalkBudget& budget() noexcept { return budget_; }

private:
    [[nodiscard]] float nearest_quanta(const KernelProbe& probe,
                                       float enough) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] float nearest_in_block(std::uint32_t block,
                                         const KernelProbe& probe) noexcept TACTUS_NONBLOCKING;

    const AbTree* other_{nullptr};
    MeshPlacement there_;
    WalkBudget budget_;
    QueryMemory memory_;
};

/// Walk of the blocks of a tree that are near another surface, by the spheres round their boxes,
/// nearest first. Each box costs a query of the other surface.
class SurfaceWalk
{
public:
    struct Item
    {
        TreeRef ref;
        /// Lower bound on the distance of the subtree's faces from the other surface.
        double gap_m{0.0};
        Sphere sphere; ///< Sphere round the subtree's box.
    };

    SurfaceWalk(const AbTree& tree, OtherSurface& other) noexcept TACTUS_NONBLOCKING;

    /// Returns the next block that may have faces within `bound_m`; kNoNode if there is none or the
    /// budget is spent.
    [[nodiscard]] std::uint32_t next_block(double bound_m) noexcept TACTUS_NONBLOCKING;

    /// Sphere round the last block of next_block().
    [[nodiscard]] const Sphere& sphere() const noexcept { return sphere_; }
    /// Parts not visited because the budget was spent; empty after a complete walk.
    [[nodiscard]] std::span<const Item> left() const noexcept { return stack_.view(); }

private:
    void push_children(const AbNode& node, double least_m,
                       double bound_m) noexcept TACTUS_NONBLOCKING;

    const AbTree& tree_;
    OtherSurface& other_;
    StaticVector<Item, kTreeStack> stack_;
    Sphere sphere_;
};

/// Sphere round a box or a triangle; as small as possible without a search.
[[nodiscard]] Sphere sphere_round(const Aabb& box) noexcept TACTUS_NONBLOCKING;
[[nodiscard]] Sphere sphere_round(const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
