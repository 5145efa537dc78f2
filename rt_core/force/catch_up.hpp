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
/// After a frame in which the proxy waited, the force changes by what the hand did, and by
/// kCatchUp_n_per_s on its way to the wanted one. Else it is the wanted one to the last bit. For
/// torques the same with newton metres. Haptic thread; some 10 ns.
class CatchUp
{
public:
    /// What goes out.
    /// - `by_hand`: change of the force that the hand's own motion makes, since the last frame.
    /// - `outward`: what goes out never points against it.
    /// - `rate_per_s` > 0.
    struct Wish
    {
        Vec3 wanted{0.0, 0.0, 0.0};
        Vec3 by_hand{0.0, 0.0, 0.0};
        Vec3 outward{0.0, 0.0, 0.0};
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
