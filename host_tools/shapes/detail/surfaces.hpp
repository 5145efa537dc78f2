// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace tactus::detail
{

/// Closed plate of 100 x 100 mm over z = 0, both sides cut into cells x cells squares: 4 x cells x
/// (cells + 2) faces. At least one cell.
[[nodiscard]] TriangleMesh make_plate(std::uint32_t cells, double thickness_m);

/// Unit sphere: an icosahedron whose edges are cut into `n` parts each, 20 n^2 faces, 10 n^2 + 2
/// vertices.
[[nodiscard]] TriangleMesh make_icosphere(std::uint32_t n);

/// Corner of an outline that is rotated around the z axis.
struct OutlinePoint
{
    double from_axis_m{0.0};
    double z_m{0.0};
};

/// Solid of revolution of an outline. The outline's first and last corners are on the axis, the
/// first below the last; the outside lies on the right. Between these corners it gets `rings`
/// circles of `segments` vertices each, including one circle at each corner: 2 x segments x rings
/// faces. `rings` is at least the number of corners between the ends, `segments` at least 3.
[[nodiscard]] TriangleMesh make_turned(std::span<const OutlinePoint> outline,
                                       std::uint32_t segments, std::uint32_t rings);

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
