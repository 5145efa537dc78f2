// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/other_surface.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rotation.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/probe.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/query/tree_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus
{

MeshPlacement MeshPlacement::inverse() const noexcept
{
    TACTUS_ASSERT(place.scale > 0.0);
    TACTUS_ASSERT(is_orthonormal(place.rotation, kRotationTolerance));
    const double scale = 1.0 / place.scale;
    // there = origin + scale R (here + offset), so here = R^T / scale (there - origin) - offset.
    return {{place.rotation.transpose(), -offset_m, scale}, -place.translation_m};
}

double MeshPlacement::rounding_m(const Vec3& here_m) const noexcept
{
    return kPoseRounding *
           (place.translation_m.norm() + place.scale * (here_m.norm() + offset_m.norm()));
}

double OtherSurface::lower_bound_m(const Sphere& sphere, double enough_m) noexcept
{
    TACTUS_ASSERT(other_ != nullptr);
    TACTUS_ASSERT(sphere.radius >= 0.0);
    const auto quantum = static_cast<double>(other_->quantum_m());
    const double scale = there_.place.scale;
    const double rounding = there_.rounding_m(sphere.center);
    const Vec3 center = there_.local_to_world(sphere.center);
    const double enough = ((enough_m + sphere.radius) * scale + rounding) / quantum * kRoundedUp;
    double nearest_m = 0.0;
    if (is_beyond_kernels(center, other_->quantum_m()))
    {
        nearest_m = query_distance(*other_, center, kInfinity, memory_, budget_).lower_m;
    }
    else if (other_->is_complete())
    {
        const float limit = enough < kFarQuanta ? round_up_to_float(enough)
                                                : std::numeric_limits<float>::infinity();
        const KernelProbe probe = make_probe(center, other_->quantum_m());
        nearest_m = static_cast<double>(nearest_quanta(probe, limit)) * quantum;
    }
    return (nearest_m - rounding) / scale / kRoundedUp - sphere.radius;
}

double OtherSurface::upper_bound_m(const Sphere& sphere) noexcept
{
    TACTUS_ASSERT(other_ != nullptr);
    TACTUS_ASSERT(sphere.radius >= 0.0);
    const DistanceAnswer answer =
        query_distance(*other_, there_.local_to_world(sphere.center), kInfinity, memory_, budget_);
    return (answer.upper_m + there_.rounding_m(sphere.center)) / there_.place.scale * kRoundedUp +
           sphere.radius;
}

/// Lower bound on the distances of all faces less their errors, in quanta; at most `enough`.
float OtherSurface::nearest_quanta(const KernelProbe& probe, float enough) noexcept
{
    float nearest = enough;
    const std::uint32_t warm =
        other_->is_block_in_use(memory_.block) && budget_.take_node() ? memory_.block : kNoNode;
    if (warm != kNoNode)
    {
        nearest = std::min(nearest, nearest_in_block(warm, probe));
    }
    TreeWalk walk(*other_, probe, budget_);
    for (std::uint32_t block = walk.next_block(nearest, false); block != kNoNode;
         block = walk.next_block(nearest, false))
    {
        const float found = block == warm ? nearest : nearest_in_block(block, probe);
        memory_.block = found < nearest ? block : memory_.block;
        nearest = std::min(nearest, found);
    }
    for (const WalkItem& item : walk.left())
    {
        nearest = std::min(nearest, item.gap);
    }
    return std::max(nearest, 0.0F);
}

float OtherSurface::nearest_in_block(std::uint32_t block, const KernelProbe& probe) noexcept
{
    const BlockGeometry& geometry = other_->block(block);
    const BlockSide& side = other_->side(block);
    if (!budget_.take_triangles(face_count(geometry)))
    {
        return 0.0F;
    }
    FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
    bound_faces(other_->kernels(), geometry, geometry.faces, probe, bounds);
    float nearest = std::numeric_limits<float>::infinity();
    for (std::uint32_t lanes = geometry.faces; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
        nearest = std::min(nearest, bounds.lower[lane] - error_in_quanta(side.errors[lane]));
    }
    return nearest;
}

SurfaceWalk::SurfaceWalk(const AbTree& tree, OtherSurface& other) noexcept
    : tree_(tree), other_(other)
{
    if (!tree.root().is_none())
    {
        const Sphere sphere = sphere_round(tree.box());
        stack_.push_back({tree.root(), -sphere.radius, sphere});
    }
}

std::uint32_t SurfaceWalk::next_block(double bound_m) noexcept
{
    while (!stack_.empty())
    {
        const Item item = stack_[stack_.size() - 1];
        if (item.gap_m > bound_m)
        {
            stack_.pop_back();
            continue;
        }
        if (!other_.budget().take_node())
        {
            return kNoNode;
        }
        stack_.pop_back();
        if (item.ref.is_block())
        {
            sphere_ = item.sphere;
            return item.ref.index();
        }
        push_children(tree_.node(item.ref.index()), item.gap_m, bound_m);
    }
    return kNoNode;
}

void SurfaceWalk::push_children(const AbNode& node, double least_m, double bound_m) noexcept
{
    TACTUS_ASSERT(node.in_use);
    const std::size_t first = stack_.size();
    for (std::uint32_t left = node.mask; left != 0; left &= left - 1)
    {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(left));
        const Sphere sphere = sphere_round(node.box_of(child));
        const double gap = std::max(least_m, other_.lower_bound_m(sphere, bound_m));
        if (gap > bound_m)
        {
            continue;
        }
        stack_.push_back({node.children[child], gap, sphere});
        // The nearest child goes on top, the others below in any order.
        const std::size_t top = stack_.size() - 1;
        if (top > first && stack_[top].gap_m > stack_[top - 1].gap_m)
        {
            std::swap(stack_[top], stack_[top - 1]);
        }
    }
}

Sphere sphere_round(const Aabb& box) noexcept
{
    Sphere sphere;
    Vec3 half(0.0, 0.0, 0.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto low = static_cast<double>(box.low[axis]);
        const auto high = static_cast<double>(box.high[axis]);
        sphere.center[static_cast<Eigen::Index>(axis)] = 0.5 * (low + high);
        half[static_cast<Eigen::Index>(axis)] = 0.5 * (high - low);
    }
    sphere.radius = half.norm() * kRoundedUp;
    return sphere;
}

Sphere sphere_round(const Triangle& triangle) noexcept
{
    Sphere sphere;
    const Vec3 low = least_of(least_of(triangle[0], triangle[1]), triangle[2]);
    const Vec3 high = greatest_of(greatest_of(triangle[0], triangle[1]), triangle[2]);
    sphere.center = 0.5 * (low + high);
    double radius_sq = 0.0;
    for (const Vec3& corner : triangle)
    {
        radius_sq = std::max(radius_sq, (corner - sphere.center).squaredNorm());
    }
    sphere.radius = std::sqrt(radius_sq) * kRoundedUp;
    return sphere;
}

} // namespace tactus
