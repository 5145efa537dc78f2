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
/// differences, two products, one difference, two sums. The ninth covers products of these
/// errors.
constexpr double kVolumeError = 9.0 * 0x1p-53;
/// Differences are exact in double-double, and a term has been rounded at most five times, 2^-102
/// each; relative to a value of at least this share of the terms, that is under 2^-55.
constexpr double kLeastVolumeLeft = 0x1p-44;
/// Rounding of an area, as a share of its terms' sizes: two differences, one product, one
/// difference, and one for products of these errors.
constexpr double kAreaError = 5.0 * 0x1p-53;
/// Products below this may have lost bits.
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

/// Cross product with its terms' magnitudes added instead of subtracted.
Triple<double> cross_terms(const Triple<double>& u, const Triple<double>& v) noexcept
{
    return {std::abs(u.y * v.z) + std::abs(u.z * v.y), std::abs(u.z * v.x) + std::abs(u.x * v.z),
            std::abs(u.x * v.y) + std::abs(u.y * v.x)};
}

/// Determinant with its terms' magnitudes added instead of subtracted.
double size_of_terms(const Triple<double>& terms, const Triple<double>& w) noexcept
{
    return std::abs(w.x) * terms.x + std::abs(w.y) * terms.y + std::abs(w.z) * terms.z;
}

/// True if rounding can't have changed the sign of a computed determinant; `size` is the sum of the
/// magnitudes of its products. Below kLeastTrusted the products may have underflowed.
bool is_sign_known(double value, double size) noexcept
{
    return std::abs(value) > kVolumeError * size && size > kLeastTrusted;
}

Triple<double> to_high(const Triple<DoubleDouble>& a) noexcept
{
    return {a.x.high, a.y.high, a.z.high};
}

} // namespace

PlaneSides::PlaneSides(const Vec3& a, const Vec3& b, const Vec3& c) noexcept : a_(a), b_(b), c_(c)
{
    const auto u = difference<double>(b, a);
    const auto v = difference<double>(c, a);
    normal_ = cross(u, v);
    terms_ = cross_terms(u, v);
}

int PlaneSides::side_of(const Vec3& d) const noexcept
{
    const auto w = difference<double>(d, a_);
    const double value = dot(normal_, w);
    return is_sign_known(value, size_of_terms(terms_, w)) ? sign_of(value)
                                                          : exact_volume(a_, b_, c_, d).sign();
}

int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept
{
    return PlaneSides(a, b, c).side_of(d);
}

std::array<int, 3> sides_of_edges(const Vec3& a, const Vec3& b,
                                  const std::array<Vec3, 3>& triangle) noexcept
{
    const auto u = difference<double>(b, a);
    const std::array<Triple<double>, 3> corner{difference<double>(triangle[0], a),
                                               difference<double>(triangle[1], a),
                                               difference<double>(triangle[2], a)};
    std::array<int, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t next = (i + 1) % 3;
        const double value = dot(cross(u, corner[i]), corner[next]);
        const double size = size_of_terms(cross_terms(u, corner[i]), corner[next]);
        sides[i] = is_sign_known(value, size)
                       ? sign_of(value)
                       : exact_volume(a, b, triangle[i], triangle[next]).sign();
    }
    return sides;
}

PlaneVolumes::PlaneVolumes(const Vec3& a, const Vec3& b, const Vec3& c) noexcept
    : a_(a), b_(b), c_(c)
{
    const auto u = difference<DoubleDouble>(b, a);
    const auto v = difference<DoubleDouble>(c, a);
    normal_ = cross(u, v);
    terms_ = cross_terms(to_high(u), to_high(v));
}

double PlaneVolumes::volume(const Vec3& d) const noexcept
{
    const auto w = difference<DoubleDouble>(d, a_);
    const double value = to_double(dot(normal_, w));
    const double size = size_of_terms(terms_, to_high(w));
    return std::abs(value) > kLeastVolumeLeft * size && size > kLeastTrusted
               ? value
               : exact_volume(a_, b_, c_, d).rounded();
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept
{
    return PlaneVolumes(a, b, c).volume(d);
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
