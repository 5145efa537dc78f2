// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// `force_n`, shortened to `norm_max_n` if it is longer. Zero if a coordinate is no finite number.
[[nodiscard]] Vec3 clamp_norm(const Vec3& force_n, double norm_max_n) noexcept TACTUS_NONBLOCKING;

/// The next force from `before_n` towards `commanded_n` if it may change by `step_max_n` >= 0:
/// `commanded_n`, or the point at that distance on the straight line there. Never longer than the
/// longer one.
[[nodiscard]] Vec3 limit_change(const Vec3& before_n, const Vec3& commanded_n,
                                double step_max_n) noexcept TACTUS_NONBLOCKING;

/// The point between `from` and `to` nearest to `point`.
[[nodiscard]] Vec3 nearest_between(const Vec3& from, const Vec3& to,
                                   const Vec3& point) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
