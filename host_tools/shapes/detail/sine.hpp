// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cmath>
#include <cstddef>

namespace tactus::detail
{

inline constexpr double kPi = 3.14159265358979323846;

/// Sine for |x| < 1e3, within 1e-13: libm's last bits differ between machines, and those of a
/// generated mesh must not. Multiples of pi are subtracted in two parts; Taylor's series of the
/// rest has its next term below 2e-18 on [-pi/2, pi/2].
[[nodiscard]] inline double portable_sin(double x)
{
    constexpr double kPiHigh = 3.14159265346825122833; // 33 bits: multiples are exact.
    constexpr double kPiLow = 1.21542010130123844986e-10;
    const double turns = std::floor(x / kPi + 0.5);
    const double r = (x - turns * kPiHigh) - turns * kPiLow;
    double sum = 1.0;
    for (int n = 22; n >= 2; n -= 2)
    {
        sum = 1.0 - sum * r * r / static_cast<double>(n * (n + 1));
    }
    const bool odd = std::floor(turns * 0.5) * 2.0 != turns;
    return odd ? -r * sum : r * sum;
}

[[nodiscard]] inline double portable_cos(double x)
{
    return portable_sin(x + 0.5 * kPi);
}

} // namespace tactus::detail
