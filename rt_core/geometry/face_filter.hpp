// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus
{

/// Allowance for the rounding of one comparison in double, in local lengths; several times the
/// largest error seen.
inline constexpr double kFilterMargin = 64.0 * 0x1p-53;

/// Heights of points over a triangle, in double, for filters. Points that may be over the triangle
/// count as over it.
class FaceFilter
{
public:
    /// Makes a filter for points up to `length` >= 0 (asserted) away from the corners.
    FaceFilter(const Triangle& triangle, double length) noexcept : corner_(triangle)
    {
        TACTUS_ASSERT(length >= 0.0);
        const std::array<Vec3, 3> edge{triangle[1] - triangle[0], triangle[2] - triangle[1],
                                       triangle[0] - triangle[2]};
        const double longest_sq =
            std::max({edge[0].squaredNorm(), edge[1].squaredNorm(), edge[2].squaredNorm()});
        const Vec3 normal = exact_normal(triangle, longest_sq);
        const double size = normal.norm();
        has_plane_ = size > 0.0;
        if (has_plane_)
        {
            unit_normal_ = normal / size;
            for (std::size_t i = 0; i < 3; ++i)
            {
                outward_[i] = edge[i].cross(unit_normal_);
                slack_[i] = kFilterMargin * edge[i].norm() * length;
            }
        }
    }

    /// Unit normal of the triangle; zero if it is so thin that its edges represent it.
    [[nodiscard]] const Vec3& unit_normal() const noexcept { return unit_normal_; }

    /// Height of a point over the triangle, >= 0, within kFilterMargin; infinite if the point is
    /// not over it.
    [[nodiscard]] double height_of(const Vec3& point) const noexcept
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (!has_plane_ || outward_[i].dot(corner_[i] - point) < -slack_[i])
            {
                return kInfinity;
            }
        }
        return std::abs(unit_normal_.dot(corner_[0] - point));
    }

private:
    Triangle corner_;
    /// Vectors edge x unit normal: outward, in the plane, as long as the edges.
    std::array<Vec3, 3> outward_{};
    std::array<double, 3> slack_{}; ///< Bounds on the rounding of products with `outward_`.
    Vec3 unit_normal_{0.0, 0.0, 0.0};
    bool has_plane_{false};
};

} // namespace tactus
