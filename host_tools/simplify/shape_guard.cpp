// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/shape_guard.hpp"

#include "host_tools/simplify/grid_point.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Least cosine of the angle between a face's normals before and after a collapse; below it, the
/// collapse is a fold.
constexpr double kLeastTurnCosine = 0.2;
/// Limit of double area over the sum of squared sides, which is 0.289 for an equilateral triangle.
/// Below it a face is thin, about one in nine.
constexpr double kThin = 0.1;

struct Shape
{
    Vec3 normal; ///< Normal; its length is twice the area.
    double double_area;
    double roundness;
};

Shape shape_of(const Vec3& apex, const Vec3& left, const Vec3& right) noexcept
{
    const Vec3 to_left = left - apex;
    const Vec3 to_right = right - apex;
    const Vec3 normal = to_left.cross(to_right);
    const double double_area = normal.norm();
    const double sides =
        to_left.squaredNorm() + to_right.squaredNorm() + (right - left).squaredNorm();
    return {normal, double_area, sides > 0 ? double_area / sides : 0};
}

Spoils compare(const Shape& before, const Shape& after) noexcept
{
    if (before.double_area <= 0)
    {
        return Spoils::nothing;
    }
    const double turn = before.normal.dot(after.normal);
    if (after.double_area <= 0 || turn < 0)
    {
        return Spoils::face;
    }
    if (turn < kLeastTurnCosine * before.double_area * after.double_area)
    {
        return Spoils::fold;
    }
    const bool thin = after.roundness < kThin && 2 * after.roundness < before.roundness;
    return thin ? Spoils::thinness : Spoils::nothing;
}

} // namespace

Spoils spoils(const QuantisedMesh& mesh, const Star& star) noexcept
{
    const Vec3 from = grid_point(mesh, star.vertex);
    const Vec3 to = grid_point(mesh, star.parent);
    Spoils worst = Spoils::nothing;
    Vec3 left = grid_point(mesh, star.rim[0]);
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        const Vec3 right = grid_point(mesh, star.rim[i + 1]);
        worst = std::max(worst, compare(shape_of(from, left, right), shape_of(to, left, right)));
        left = right;
    }
    return worst;
}

} // namespace tactus
