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

/// The next force on the way from `before_n` to `wished_n` when it may grow by `step_max_n`:
///
///     wished ^            straight towards the wish by one step, then without what points against
///            |  . next    the wish, then no longer than the wish
///            | /
///            o-----> before
///
/// So it grows by at most `step_max_n` in norm, never is longer than the wish and never points
/// against it. It shrinks as fast as the wish does: a wall that the tool has left must not push on.
[[nodiscard]] Vec3 limit_growth(const Vec3& before_n, const Vec3& wished_n,
                                double step_max_n) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
