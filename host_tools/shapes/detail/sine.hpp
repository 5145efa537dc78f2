// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cmath>
#include <cstddef>

namespace tactus::detail
{

inline constexpr double kPi = 3.14159265358979323846;

/// sin for |x| < 1e3, within 1e-13: libm's last bits differ between machines, and a generated mesh
/// must not. Half turns are taken off with pi in two parts, the rest by Taylor's series, whose next
/// term is below 2e-18 on [-pi/2, pi/2].
[[nodiscard]] inline double portable_sin(double x)
{
    constexpr double kPiHigh = 3.14159265346825122833; // 33 bits: its multiples are exact.
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
