// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/tree_walk.hpp"

#include <utility>

namespace tactus
{

/// How a model's frame lies in another model's: there = origin + scale x rotation x (here +
/// offset).
struct MeshPlacement
{
    Similarity place;
    Vec3 offset_m{0.0, 0.0, 0.0};

    [[nodiscard]] Vec3 local_to_world(const Vec3& here_m) const noexcept
    {
        return place.local_to_world(here_m + offset_m);
    }
    /// The way back.
    [[nodiscard]] MeshPlacement inverse() const noexcept TACTUS_NONBLOCKING;
    /// What `local_to_world` may be off by, in metres there.
    [[nodiscard]] double rounding_m(const Vec3& here_m) const noexcept TACTUS_NONBLOCKING;
};

/// Another model's surface, as it lies in a model's frame: the measure of what a tool that is a
/// mesh needs of an object, and the object of the tool. All lengths are of the frame here. Good for
/// one frame; what it may look at in all is in its budget. Haptic thread.
class OtherSurface
{
public:
    OtherSurface() noexcept = default;
    /// The other's boxes must be right (AbTree::refit) whenever this is asked.
    OtherSurface(const AbTree& other, MeshPlacement there, const WalkBudget& budget) noexcept
        : other_(&other), there_(std::move(there)), budget_(budget)
    {
    }

    /// Less than any distance from a point of the sphere, down to minus the sphere's radius; beyond
    /// `enough_m` any that is not below it. In single precision.
    [[nodiscard]] double lower_bound_m(const Sphere& sphere,
                                       double enough_m) noexcept TACTUS_NONBLOCKING;
    /// More than the distance from some point of the sphere to the other's original surface, if the
    /// sphere holds any of what is asked for.
    [[nodiscard]] double upper_bound_m(const Sphere& sphere) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const AbTree& tree() const noexcept { return *other_; }
    /// Of the frame here in the other's.
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

/// Walks the blocks of a tree that are near another surface, by spheres round their boxes, nearest
/// first. Each box looked at is a question to the other surface.
class SurfaceWalk
{
public:
    struct Item
    {
        TreeRef ref;
        double gap_m{0.0}; ///< Everything in it is at least this far from the other surface.
        Sphere sphere;     ///< Round its box.
    };

    SurfaceWalk(const AbTree& tree, OtherSurface& other) noexcept TACTUS_NONBLOCKING;

    /// The next block of which something may be within `bound_m`, or kNoNode when there is none or
    /// the budget is spent.
    [[nodiscard]] std::uint32_t next_block(double bound_m) noexcept TACTUS_NONBLOCKING;

    /// Round the block that next_block() gave last.
    [[nodiscard]] const Sphere& sphere() const noexcept { return sphere_; }
    /// What was not visited when the budget was spent; empty after a complete walk.
    [[nodiscard]] std::span<const Item> left() const noexcept { return stack_.view(); }

private:
    void push_children(const AbNode& node, double least_m,
                       double bound_m) noexcept TACTUS_NONBLOCKING;

    const AbTree& tree_;
    OtherSurface& other_;
    StaticVector<Item, kTreeStack> stack_;
    Sphere sphere_;
};

/// Round a box, and round a triangle; as small as is found without search.
[[nodiscard]] Sphere sphere_round(const Aabb& box) noexcept TACTUS_NONBLOCKING;
[[nodiscard]] Sphere sphere_round(const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
