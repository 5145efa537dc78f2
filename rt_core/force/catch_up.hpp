// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// Force of a proxy that waited for data and then moves at once: it continues from its old value
/// and catches up.
///
///     wanted     ________----------
///                       |      __--
///     sent       _______|__----
///                 waits | free again
///
/// After a frame in which the proxy waited, the force approaches the wanted one. Its change per
/// frame is limited to that by the device's displacement, plus the rate. The remaining lag
/// decreases by the rate. Otherwise the force is the wanted one to the last bit. A lagging force
/// may briefly point into a surface that has rotated meanwhile. For torques the same with newton
/// metres. Haptic thread; about 10 ns.
class CatchUp
{
public:
    /// Next force to send.
    /// - `wanted` is no longer than `longest`.
    /// - `rate_per_s` > 0.
    struct Command
    {
        Vec3 wanted{0.0, 0.0, 0.0};
        /// Largest change by the device's displacement since the last frame.
        double by_hand{0.0};
        double longest{0.0}; ///< Largest norm of the result.
        double rate_per_s{0.0};
        double elapsed_s{0.0};
        bool has_waited{false}; ///< The last frame's proxy waited.
    };
    [[nodiscard]] Vec3 next(const Command& commanded) noexcept TACTUS_NONBLOCKING;

    /// Continues from `sent`, which replaced the last result.
    void follow(const Vec3& sent) noexcept
    {
        sent_ = sent;
        lag_ = Vec3(0.0, 0.0, 0.0);
    }

private:
    Vec3 sent_{0.0, 0.0, 0.0};
    Vec3 lag_{0.0, 0.0, 0.0}; ///< Sent minus wanted.
};

} // namespace tactus
