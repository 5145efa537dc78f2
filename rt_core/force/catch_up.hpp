// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// The force of a proxy that had to wait for data, and then is somewhere else at once: it goes on
/// from what it was and catches up.
///
///     wanted     ________----------
///                       |      __--
///     sent       _______|__----
///                 waits | free again
///
/// After a frame in which the proxy waited, the force goes towards the wanted one by no more than
/// the hand's own way may have changed it, and the rate. What it then lags behind goes by the rate.
/// Else it is the wanted one to the last bit. A force that lags may for some moments point into a
/// surface that has turned meanwhile. For torques the same with newton metres. Haptic thread; some
/// 10 ns.
class CatchUp
{
public:
    /// What goes out.
    /// - `wanted` is no longer than `longest`.
    /// - `rate_per_s` > 0.
    struct Wish
    {
        Vec3 wanted{0.0, 0.0, 0.0};
        double by_hand{0.0}; ///< What the hand's way since the last frame may change, at most.
        double longest{0.0}; ///< Norm of what goes out.
        double rate_per_s{0.0};
        double elapsed_s{0.0};
        bool has_waited{false}; ///< In the last frame.
    };
    [[nodiscard]] Vec3 next(const Wish& wish) noexcept TACTUS_NONBLOCKING;

    /// This went out instead.
    void follow(const Vec3& sent) noexcept
    {
        sent_ = sent;
        lag_ = Vec3(0.0, 0.0, 0.0);
    }

private:
    Vec3 sent_{0.0, 0.0, 0.0};
    Vec3 lag_{0.0, 0.0, 0.0}; ///< Sent less wanted.
};

} // namespace tactus
