// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/other_surface.hpp"

#include "rt_core/query/surface_query.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus
{

namespace
{

constexpr double kRoundedUp = 1.0 + 1e-14;

} // namespace

MeshPlacement MeshPlacement::inverse() const noexcept
{
    const double scale = 1.0 / place.scale;
    // there = origin + scale R (here + offset), so here = R^T / scale (there - origin) - offset.
    return {{place.rotation.transpose(), -offset_m, scale}, -place.origin};
}

double MeshPlacement::rounding_m(const Vec3& here_m) const noexcept
{
    return kPoseRounding * (place.origin.norm() + place.scale * (here_m.norm() + offset_m.norm()));
}

OtherSurface::Bounds OtherSurface::distance(const Vec3& point_m, double enough_m) noexcept
{
    const double scale = there_.place.scale;
    const double rounding = there_.rounding_m(point_m);
    const double band = (enough_m * scale + rounding) * kRoundedUp;
    const DistanceAnswer answer =
        query_distance(*other_, there_.to_there(point_m), band, memory_, budget_);
    return {(answer.lower_m - rounding) / scale / kRoundedUp,
            (answer.upper_m + rounding) / scale * kRoundedUp};
}

SurfaceWalk::SurfaceWalk(const AbTree& tree, OtherSurface& other) noexcept
    : tree_(tree), other_(other)
{
    if (!tree.root().is_none())
    {
        const Ball ball = ball_round(tree.box());
        stack_.push_back({tree.root(), -ball.radius, ball});
    }
}

std::uint32_t SurfaceWalk::next_block(double bound_m, bool coarse_only) noexcept
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
            ball_ = item.ball;
            return item.ref.index();
        }
        push_children(tree_.node(item.ref.index()), item.gap_m, bound_m, coarse_only);
    }
    return kNoNode;
}

void SurfaceWalk::push_children(const AbNode& node, double least_m, double bound_m,
                                bool coarse_only) noexcept
{
    const std::uint32_t wanted = coarse_only ? node.mask & node.coarse : node.mask;
    const std::size_t first = stack_.size();
    for (std::uint32_t left = wanted; left != 0; left &= left - 1)
    {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(left));
        const Ball ball = ball_round(node.box_of(child));
        const double gap = std::max(least_m, other_.lower_bound_m(ball, bound_m));
        if (gap > bound_m)
        {
            continue;
        }
        stack_.push_back({node.children[child], gap, ball});
        // The nearest on top, the others below in any order.
        const std::size_t top = stack_.size() - 1;
        if (top > first && stack_[top].gap_m > stack_[top - 1].gap_m)
        {
            std::swap(stack_[top], stack_[top - 1]);
        }
    }
}

Ball ball_round(const Aabb& box) noexcept
{
    Ball ball;
    Vec3 half(0.0, 0.0, 0.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto low = static_cast<double>(box.low[axis]);
        const auto high = static_cast<double>(box.high[axis]);
        ball.center[static_cast<Eigen::Index>(axis)] = 0.5 * (low + high);
        half[static_cast<Eigen::Index>(axis)] = 0.5 * (high - low);
    }
    ball.radius = half.norm() * kRoundedUp;
    return ball;
}

Ball ball_round(const Triangle& triangle) noexcept
{
    Ball ball;
    ball.center = 0.5 * (triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]) +
                         triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]));
    double radius_sq = 0.0;
    for (const Vec3& corner : triangle)
    {
        radius_sq = std::max(radius_sq, (corner - ball.center).squaredNorm());
    }
    ball.radius = std::sqrt(radius_sq) * kRoundedUp;
    return ball;
}

} // namespace tactus
