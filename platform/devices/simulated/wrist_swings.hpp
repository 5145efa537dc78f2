// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/phasor.hpp"
#include "rt_core/math/rotation.hpp"

namespace tactus
{

/// Rotations of a wrist to and fro about the world's axes in turn: a swing goes from rest one way,
/// back, the other way, and to rest again. Arithmetic and square roots only.
class WristSwings
{
public:
    /// `axes`: number of axes to swing about, x first. `half_tangent`: tangent of half the largest
    /// angle.
    WristSwings(double half_tangent, double swings_per_s, int axes, double period_s) noexcept
        : half_tangent_(half_tangent), axes_(axes), phasor_(swings_per_s, period_s)
    {
    }

    /// Advances by one period.
    void step() noexcept
    {
        const bool was_back = phasor_.sin() < 0.0;
        phasor_.turn();
        axis_ = was_back && phasor_.sin() >= 0.0 ? (axis_ + 1) % axes_ : axis_;
    }

    /// Present rotation. The third power of the sine lets each swing start and end at rest.
    [[nodiscard]] Mat3 rotation() const noexcept
    {
        const double sine = phasor_.sin();
        return turned_by(Vec3::Unit(axis_) * (2.0 * half_tangent_ * sine * sine * sine),
                         Mat3::Identity());
    }

private:
    double half_tangent_;
    int axes_;
    int axis_{0};
    Phasor phasor_;
};

} // namespace tactus
