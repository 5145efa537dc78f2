// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <cmath>
#include <numbers>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Arc tangent in rad of a number that is not negative (asserted), correct to about 1e-16. It uses
/// IEEE operations only: libm's results differ between platforms.
[[nodiscard]] inline double arc_tangent(double t) noexcept
{
    TACTUS_ASSERT(t >= 0.0);
    const bool is_steep = t > 1.0;
    double x = is_steep ? 1.0 / t : t;
    constexpr int kHalvings = 3; // They reduce the angle to pi / 32 at most, where nine terms
                                 // suffice.
    for (int i = 0; i < kHalvings; ++i)
    {
        x = x / (1.0 + std::sqrt(1.0 + x * x));
    }
    double sum = 0.0;
    for (int power = 17; power >= 1; power -= 2)
    {
        sum = (power % 4 == 1 ? 1.0 : -1.0) / power + x * x * sum;
    }
    const double angle = (1 << kHalvings) * x * sum;
    return is_steep ? 0.5 * std::numbers::pi - angle : angle;
}

} // namespace tactus
