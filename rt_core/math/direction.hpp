// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/safe_scale.hpp"

namespace tactus
{

/// Largest coordinate of a vector, in its unit, up to which it counts as nearly zero. Quotients by
/// larger ones stay in the range of doubles.
inline constexpr double kNearlyZero = 1e-300;

/// True if a vector has a direction: it is neither zero, nearly zero, infinite nor undefined.
[[nodiscard]] inline bool has_direction(const Vec3& way) noexcept
{
    return way.allFinite() && largest_coordinate({&way, 1}) > kNearlyZero;
}

/// The vector scaled to length 1 within a few roundings, however long it is; it must have a
/// direction.
[[nodiscard]] inline Vec3 unit_of(const Vec3& way) noexcept
{
    TACTUS_ASSERT(has_direction(way));
    const Vec3 near_one = way / largest_coordinate({&way, 1});
    return near_one / near_one.norm();
}

} // namespace tactus
