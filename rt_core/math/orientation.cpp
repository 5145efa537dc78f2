// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/orientation.hpp"

#include "rt_core/math/expansion.hpp"
#include "rt_core/math/triple.hpp"

#include <cmath>

namespace tactus
{

namespace
{

/// Each term of the determinant has been rounded at most eight times, 2^-53 each: three
/// differences, two products, one difference, two sums. The ninth stands for products of these
/// errors.
constexpr double kVolumeError = 9.0 * 0x1p-53;
/// In double-double differences are exact, and a term has been rounded at most five times, 2^-102
/// each; seen from a value that is no smaller than this share of the terms, that is under 2^-55.
constexpr double kLeastVolumeLeft = 0x1p-44;
/// As above: two differences, one product, one difference.
constexpr double kAreaError = 5.0 * 0x1p-53;
/// Below this products may have lost bits.
constexpr double kLeastTrusted = 1e-280;

int sign_of(double value) noexcept
{
    return value > 0.0 ? 1 : (value < 0.0 ? -1 : 0);
}

/// p.x q.y - p.y q.x
Expansion<16> exact_minor(const DoubleDouble& px, const DoubleDouble& py, const DoubleDouble& qx,
                          const DoubleDouble& qy) noexcept
{
    return Expansion<2>(px) * qy + Expansion<2>(-py) * qx;
}

Expansion<192> exact_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept
{
    const auto u = difference<DoubleDouble>(b, a);
    const auto v = difference<DoubleDouble>(c, a);
    const auto w = difference<DoubleDouble>(d, a);
    return exact_minor(u.y, u.z, v.y, v.z) * w.x + exact_minor(u.z, u.x, v.z, v.x) * w.y +
           exact_minor(u.x, u.y, v.x, v.y) * w.z;
}

/// Of the determinant of the three, each as large as it can be.
double size_of_terms(const Triple<double>& u, const Triple<double>& v,
                     const Triple<double>& w) noexcept
{
    return std::abs(w.x) * (std::abs(u.y * v.z) + std::abs(u.z * v.y)) +
           std::abs(w.y) * (std::abs(u.z * v.x) + std::abs(u.x * v.z)) +
           std::abs(w.z) * (std::abs(u.x * v.y) + std::abs(u.y * v.x));
}

Triple<double> to_high(const Triple<DoubleDouble>& a) noexcept
{
    return {a.x.high, a.y.high, a.z.high};
}

} // namespace

int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept
{
    const auto u = difference<double>(b, a);
    const auto v = difference<double>(c, a);
    const auto w = difference<double>(d, a);
    const double value = dot(cross(u, v), w);
    const double size = size_of_terms(u, v, w);
    if (std::abs(value) > kVolumeError * size && size > kLeastTrusted)
    {
        return sign_of(value);
    }
    return exact_volume(a, b, c, d).sign();
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept
{
    const auto u = difference<DoubleDouble>(b, a);
    const auto v = difference<DoubleDouble>(c, a);
    const auto w = difference<DoubleDouble>(d, a);
    const double value = to_double(dot(cross(u, v), w));
    const double size = size_of_terms(to_high(u), to_high(v), to_high(w));
    if (std::abs(value) > kLeastVolumeLeft * size && size > kLeastTrusted)
    {
        return value;
    }
    return exact_volume(a, b, c, d).rounded();
}

int side_of_line(const Vec2& a, const Vec2& b, const Vec2& c) noexcept
{
    const double left = (b[0] - a[0]) * (c[1] - a[1]);
    const double right = (b[1] - a[1]) * (c[0] - a[0]);
    const double size = std::abs(left) + std::abs(right);
    if (std::abs(left - right) > kAreaError * size && size > kLeastTrusted)
    {
        return sign_of(left - right);
    }
    return exact_minor(two_difference(b[0], a[0]), two_difference(b[1], a[1]),
                       two_difference(c[0], a[0]), two_difference(c[1], a[1]))
        .sign();
}

} // namespace tactus
