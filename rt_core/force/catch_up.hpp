// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// Continuation of a force after its proxy waited for data and then moves at once: the sent force
/// starts at its old value and catches up with the wanted force.
///
///     wanted     ________----------
///                       |      __--
///     sent       _______|__----
///                 waits | free again
///
/// After a frame in which the proxy waited, the sent force approaches the wanted one by at most
/// `rate_per_s` and, in that frame, `by_hand`. Otherwise it is the wanted force to the last bit. A
/// lagging force may briefly point into a surface that has rotated meanwhile. Torques follow the
/// same law in newton metres. Haptic thread; about 10 ns.
class CatchUp
{
public:
    /// Input of next(), which returns the next force to send.
    /// - `wanted` is no longer than `longest`.
    /// - `rate_per_s` >= 0; 0 for the torque of a tool without one.
    struct Command
    {
        Vec3 wanted{0.0, 0.0, 0.0};
        /// Largest change of the force by the device's displacement since the last frame.
        double by_hand{0.0};
        double longest{0.0}; ///< Largest norm of the next force.
        double rate_per_s{0.0};
        double elapsed_s{0.0};
        bool has_waited{false}; ///< True if the proxy waited for data in the last frame.
    };
    [[nodiscard]] Vec3 next(const Command& commanded) noexcept TACTUS_NONBLOCKING;

    /// Replaces the last result of next() by `sent`, and clears the lag.
    void follow(const Vec3& sent) noexcept
    {
        sent_ = sent;
        lag_ = Vec3(0.0, 0.0, 0.0);
    }

private:
    Vec3 sent_{0.0, 0.0, 0.0};
    Vec3 lag_{0.0, 0.0, 0.0}; ///< Sent force minus wanted force.
};

} // namespace tactus
