// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstdint>

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

/// The share of the force that goes out after a start: 0 in the first frame and 1 from `ramp_s` on,
/// in equal steps. Counts frames, not time: a stall doesn't bring the force back any faster.
class StartRamp
{
public:
    /// - `ramp_s` 0: no ramp.
    /// - `period_s` > 0.
    StartRamp(double ramp_s, double period_s) noexcept
        : step_(ramp_s > 0.0 ? period_s / ramp_s : 0.0)
    {
    }

    void restart() noexcept { frames_ = 0; }
    /// Once a frame.
    [[nodiscard]] double next_share() noexcept TACTUS_NONBLOCKING;

private:
    double step_; ///< 0: no ramp.
    std::uint32_t frames_{0};
};

} // namespace tactus
