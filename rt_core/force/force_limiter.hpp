// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// `force_n`, shortened to `norm_max_n` if it is longer. Zero if a coordinate is no finite number.
[[nodiscard]] Vec3 clamp_norm(const Vec3& force_n, double norm_max_n) noexcept TACTUS_NONBLOCKING;

/// Next force from `before_n` towards `commanded_n`, if it may change by `step_max_n` >= 0. The
/// result lies on the straight line between the two, and is never longer than the longer one.
[[nodiscard]] Vec3 limit_change(const Vec3& before_n, const Vec3& commanded_n,
                                double step_max_n) noexcept TACTUS_NONBLOCKING;

/// Point nearest to `point` on the segment from `from` to `to`.
[[nodiscard]] Vec3 nearest_between(const Vec3& from, const Vec3& to,
                                   const Vec3& point) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
