// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <limits>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Axis-aligned box in single precision, rounded outward; its owner defines frame and unit. The
/// default box is empty: its union with any box is that box.
struct Aabb
{
    Vec3f low{kHuge, kHuge, kHuge};
    Vec3f high{-kHuge, -kHuge, -kHuge};

    static constexpr float kHuge = std::numeric_limits<float>::max();

    constexpr bool operator==(const Aabb&) const noexcept = default;

    constexpr void add(const Vec3f& point) noexcept
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = point[axis] < low[axis] ? point[axis] : low[axis];
            high[axis] = point[axis] > high[axis] ? point[axis] : high[axis];
        }
    }

    constexpr void add(const Aabb& box) noexcept
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = box.low[axis] < low[axis] ? box.low[axis] : low[axis];
            high[axis] = box.high[axis] > high[axis] ? box.high[axis] : high[axis];
        }
    }

    /// The box grown by `margin` >= 0 (asserted) on all sides, rounded outward. The sums are exact
    /// in double as long as the smallest bit of one operand is less than 2^53 below the largest of
    /// the other; grid coordinates of 24 bits and error bounds up to 2^27 quanta keep that.
    [[nodiscard]] constexpr Aabb inflated(float margin) const noexcept
    {
        TACTUS_ASSERT(margin >= 0.0F);
        Aabb box;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto wide = static_cast<double>(margin);
            box.low[axis] = round_down_to_float(static_cast<double>(low[axis]) - wide);
            box.high[axis] = round_up_to_float(static_cast<double>(high[axis]) + wide);
        }
        return box;
    }
};

/// True if the box holds at least a point and its coordinates are finite; false for NaN.
[[nodiscard]] constexpr bool is_sound(const Aabb& box) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const bool is_range = box.low[axis] >= -Aabb::kHuge && box.low[axis] <= box.high[axis] &&
                              box.high[axis] <= Aabb::kHuge;
        if (!is_range)
        {
            return false;
        }
    }
    return true;
}

/// True if all of `inner` lies in `outer`.
[[nodiscard]] constexpr bool holds(const Aabb& outer, const Aabb& inner) noexcept
{
    Aabb both = outer;
    both.add(inner);
    return both == outer;
}

/// True if the boxes have a point in common.
[[nodiscard]] constexpr bool do_meet(const Aabb& a, const Aabb& b) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis])
        {
            return false;
        }
    }
    return true;
}

} // namespace tactus
