// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// `force_n` or, when it is longer than `norm_max_n`, the force of that length in its direction.
/// Zero when a coordinate is no finite number.
[[nodiscard]] Vec3 clamp_norm(const Vec3& force_n, double norm_max_n) noexcept TACTUS_NONBLOCKING;

/// The next force on the way from `before_n` to `wished_n` when it may change by `step_max_n` >= 0:
/// the wish, or on the straight line there as far as that. Never longer than the longer one.
[[nodiscard]] Vec3 limit_change(const Vec3& before_n, const Vec3& wished_n,
                                double step_max_n) noexcept TACTUS_NONBLOCKING;

/// The point between two that is nearest to a third one.
[[nodiscard]] Vec3 nearest_between(const Vec3& from, const Vec3& to,
                                   const Vec3& point) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
