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
    // The largest coordinate first: squares of what is huge are infinite.
    const double largest = largest_coordinate({&force_n, 1});
    const bool is_inside = largest <= norm_max_n && force_n.norm() <= norm_max_n;
    return is_inside ? force_n : Vec3(unit_of(force_n) * norm_max_n);
}

Vec3 limit_growth(const Vec3& before_n, const Vec3& wished_n, double step_max_n) noexcept
{
    TACTUS_ASSERT(step_max_n >= 0.0);
    const Vec3 change = wished_n - before_n;
    if (change.norm() <= step_max_n)
    {
        return wished_n;
    }
    Vec3 next = before_n + change * (step_max_n / change.norm());
    const double along = next.dot(wished_n);
    if (along < 0.0)
    {
        next -= wished_n * (along / wished_n.squaredNorm());
    }
    return clamp_norm(next, wished_n.norm());
}

} // namespace tactus
