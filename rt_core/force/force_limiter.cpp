// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_limiter.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/direction.hpp"

#include <algorithm>

namespace tactus
{

Vec3 clamp_norm(const Vec3& force_n, double norm_max_n) noexcept
{
    TACTUS_ASSERT(norm_max_n >= 0.0);
    if (!has_direction(force_n))
    {
        return {0.0, 0.0, 0.0};
    }
    // The largest coordinate is compared first, as squares of huge values are infinite.
    const double largest = largest_coordinate({&force_n, 1});
    const bool is_inside = largest <= norm_max_n && force_n.norm() <= norm_max_n;
    return is_inside ? force_n : Vec3(unit_of(force_n) * norm_max_n);
}

Vec3 limit_change(const Vec3& before_n, const Vec3& commanded_n, double step_max_n) noexcept
{
    TACTUS_ASSERT(step_max_n >= 0.0);
    const Vec3 change = commanded_n - before_n;
    const double norm = change.norm();
    return norm <= step_max_n ? commanded_n : Vec3(before_n + change * (step_max_n / norm));
}

Vec3 nearest_between(const Vec3& from, const Vec3& to, const Vec3& point) noexcept
{
    const Vec3 way = to - from;
    const double length_sq = way.squaredNorm();
    const double share =
        length_sq > 0.0 ? std::clamp((point - from).dot(way) / length_sq, 0.0, 1.0) : 0.0;
    return from + share * way;
}

} // namespace tactus
