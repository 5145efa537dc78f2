// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/shared/exact_meet.hpp"

#include "tests/shared/closest_point.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <vector>

namespace tactus::test
{
namespace
{

/// Integer of any width, for exact decisions. Slow: it allocates.
class BigInteger
{
public:
    BigInteger() = default;
    /// Integer value / 2^unit_log2; the quotient must be an integer.
    BigInteger(double value, int unit_log2);

    [[nodiscard]] int sign() const
    {
        if (digits_.empty())
        {
            return 0;
        }
        return is_negative_ ? -1 : 1;
    }

    friend BigInteger operator+(const BigInteger& a, const BigInteger& b)
    {
        return sum(a, b, b.is_negative_);
    }
    friend BigInteger operator-(const BigInteger& a, const BigInteger& b)
    {
        return sum(a, b, !b.is_negative_);
    }
    friend BigInteger operator*(const BigInteger& a, const BigInteger& b);

private:
    using Digits = std::vector<std::uint32_t>; ///< Digits, lowest first; the highest is not 0.

    [[nodiscard]] static BigInteger sum(const BigInteger& a, const BigInteger& b,
                                        bool is_b_negative);
    [[nodiscard]] static Digits added(const Digits& a, const Digits& b);
    [[nodiscard]] static Digits subtracted(const Digits& larger, const Digits& smaller);
    [[nodiscard]] static bool is_less(const Digits& a, const Digits& b);
    static void drop_zeros(Digits& digits);

    Digits digits_;
    bool is_negative_{false};
};

constexpr int kDigitBits = 32;
constexpr int kMantissaBits = 53;

/// Mantissa of a number as an integer, with the exponent of the lowest of its 53 bits.
std::uint64_t mantissa_of(double value, int& unit_log2)
{
    int exponent = 0;
    const double share = std::frexp(std::abs(value), &exponent);
    unit_log2 = exponent - kMantissaBits;
    return static_cast<std::uint64_t>(std::ldexp(share, kMantissaBits));
}

/// Exponent of the lowest bit of a finite number; the largest int for 0.
int lowest_bit_log2(double value)
{
    if (value == 0.0)
    {
        return std::numeric_limits<int>::max();
    }
    int unit_log2 = 0;
    const std::uint64_t mantissa = mantissa_of(value, unit_log2);
    return unit_log2 + std::countr_zero(mantissa);
}

BigInteger::BigInteger(double value, int unit_log2) : is_negative_(value < 0.0)
{
    if (value == 0.0)
    {
        return;
    }
    int own_log2 = 0;
    std::uint64_t mantissa = mantissa_of(value, own_log2);
    const int zeros = std::countr_zero(mantissa);
    mantissa >>= static_cast<unsigned>(zeros);
    const int shift = own_log2 + zeros - unit_log2;
    digits_.resize(static_cast<std::size_t>(shift / kDigitBits) + 3);
    const auto within = static_cast<unsigned>(shift % kDigitBits);
    const auto first = static_cast<std::size_t>(shift / kDigitBits);
    const std::uint64_t low = (mantissa & 0xFFFF'FFFFU) << within;
    const std::uint64_t high = ((mantissa >> 32U) << within) + (low >> 32U);
    digits_[first] = static_cast<std::uint32_t>(low);
    digits_[first + 1] = static_cast<std::uint32_t>(high);
    digits_[first + 2] = static_cast<std::uint32_t>(high >> 32U);
    drop_zeros(digits_);
}

void BigInteger::drop_zeros(Digits& digits)
{
    while (!digits.empty() && digits.back() == 0)
    {
        digits.pop_back();
    }
}

bool BigInteger::is_less(const Digits& a, const Digits& b)
{
    return a.size() != b.size()
               ? a.size() < b.size()
               : std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

BigInteger BigInteger::sum(const BigInteger& a, const BigInteger& b, bool is_b_negative)
{
    BigInteger result;
    const bool is_b_larger = is_less(a.digits_, b.digits_);
    result.is_negative_ = is_b_larger ? is_b_negative : a.is_negative_;
    if (a.is_negative_ == is_b_negative)
    {
        result.digits_ = added(a.digits_, b.digits_);
    }
    else
    {
        result.digits_ =
            is_b_larger ? subtracted(b.digits_, a.digits_) : subtracted(a.digits_, b.digits_);
    }
    return result;
}

BigInteger::Digits BigInteger::added(const Digits& a, const Digits& b)
{
    Digits result;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()) || carry != 0; ++i)
    {
        carry += std::uint64_t{i < a.size() ? a[i] : 0} + (i < b.size() ? b[i] : 0);
        result.push_back(static_cast<std::uint32_t>(carry));
        carry >>= 32U;
    }
    return result;
}

BigInteger::Digits BigInteger::subtracted(const Digits& larger, const Digits& smaller)
{
    Digits result;
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < larger.size(); ++i)
    {
        const std::uint64_t less = borrow + (i < smaller.size() ? smaller[i] : 0);
        result.push_back(static_cast<std::uint32_t>(larger[i] - less));
        borrow = larger[i] < less ? 1 : 0;
    }
    drop_zeros(result);
    return result;
}

BigInteger operator*(const BigInteger& a, const BigInteger& b)
{
    BigInteger result;
    result.is_negative_ = a.is_negative_ != b.is_negative_;
    result.digits_.resize(a.digits_.size() + b.digits_.size());
    for (std::size_t i = 0; i < a.digits_.size(); ++i)
    {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < b.digits_.size(); ++j)
        {
            carry += std::uint64_t{a.digits_[i]} * b.digits_[j] + result.digits_[i + j];
            result.digits_[i + j] = static_cast<std::uint32_t>(carry);
            carry >>= 32U;
        }
        result.digits_[i + b.digits_.size()] = static_cast<std::uint32_t>(carry);
    }
    BigInteger::drop_zeros(result.digits_);
    return result;
}

using Shadow = std::array<double, 2>; ///< Projection of a point along an axis.

/// Generous rounding bound: about ten roundings of 1.1e-16 each, of the sum of absolute products.
constexpr double kDoubt = 4e-15;

template <typename Real>
Real determinant(const Point<Real>& a, const Point<Real>& b, const Point<Real>& c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Sum of the absolute products of the determinant.
double magnitude(const Point<double>& a, const Point<double>& b, const Point<double>& c)
{
    const auto size = [](double x, double y) { return std::abs(x * y); };
    return std::abs(a[0]) * (size(b[1], c[2]) + size(b[2], c[1])) +
           std::abs(a[1]) * (size(b[2], c[0]) + size(b[0], c[2])) +
           std::abs(a[2]) * (size(b[0], c[1]) + size(b[1], c[0]));
}

/// False also for numbers so small that products lose bits to the least exponent.
bool is_certain(double value, double size)
{
    return std::abs(value) > kDoubt * size + 1e-280;
}

template <std::size_t N>
int common_unit(std::initializer_list<std::array<double, N>> points)
{
    int unit_log2 = std::numeric_limits<int>::max();
    for (const std::array<double, N>& point : points)
    {
        for (const double coordinate : point)
        {
            unit_log2 = std::min(unit_log2, lowest_bit_log2(coordinate));
        }
    }
    return unit_log2;
}

template <std::size_t N>
std::array<BigInteger, N> exact_difference(const std::array<double, N>& a,
                                           const std::array<double, N>& b, int unit_log2)
{
    std::array<BigInteger, N> result;
    for (std::size_t i = 0; i < N; ++i)
    {
        result[i] = BigInteger(a[i], unit_log2) - BigInteger(b[i], unit_log2);
    }
    return result;
}

int sign_of(double value)
{
    return (value > 0.0 ? 1 : 0) - (value < 0.0 ? 1 : 0);
}

Point<double> point_of(const Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Sign of det(b - a, c - a).
int area_sign(const Shadow& a, const Shadow& b, const Shadow& c)
{
    const double first = (b[0] - a[0]) * (c[1] - a[1]);
    const double second = (b[1] - a[1]) * (c[0] - a[0]);
    if (is_certain(first - second, std::abs(first) + std::abs(second)))
    {
        return sign_of(first - second);
    }
    const int unit_log2 = common_unit({a, b, c});
    const auto u = exact_difference(b, a, unit_log2);
    const auto v = exact_difference(c, a, unit_log2);
    return (u[0] * v[1] - u[1] * v[0]).sign();
}

Shadow shadow(const Vec3& point, int axis)
{
    return {point[(axis + 1) % 3], point[(axis + 2) % 3]};
}

bool are_apart(double a, double b, double c, double d)
{
    return std::max(a, b) < std::min(c, d) || std::max(c, d) < std::min(a, b);
}

bool segments_meet(const Shadow& p, const Shadow& q, const Shadow& a, const Shadow& b)
{
    return !are_apart(p[0], q[0], a[0], b[0]) && !are_apart(p[1], q[1], a[1], b[1]) &&
           area_sign(a, b, p) * area_sign(a, b, q) <= 0 &&
           area_sign(p, q, a) * area_sign(p, q, b) <= 0;
}

bool have_no_opposites(int a, int b, int c)
{
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool is_inside(const Shadow& p, const Shadow& a, const Shadow& b, const Shadow& c)
{
    return have_no_opposites(area_sign(a, b, p), area_sign(b, c, p), area_sign(c, a, p));
}

bool has_area(const Triangle& t)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        if (area_sign(shadow(t[0], axis), shadow(t[1], axis), shadow(t[2], axis)) != 0)
        {
            return true;
        }
    }
    return false;
}

/// True if a segment and a triangle in one plane meet.
bool edge_meets_in_plane(const Vec3& p, const Vec3& q, const Triangle& t)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const Shadow from = shadow(p, axis);
        const Shadow to = shadow(q, axis);
        const Shadow a = shadow(t[0], axis);
        const Shadow b = shadow(t[1], axis);
        const Shadow c = shadow(t[2], axis);
        if (!is_inside(from, a, b, c) && !segments_meet(from, to, a, b) &&
            !segments_meet(from, to, b, c) && !segments_meet(from, to, c, a))
        {
            return false;
        }
    }
    return true;
}

bool edges_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b)
{
    if (exact_volume_sign(p, q, a, b) != 0)
    {
        return false;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!segments_meet(shadow(p, axis), shadow(q, axis), shadow(a, axis), shadow(b, axis)))
        {
            return false;
        }
    }
    return true;
}

bool edge_meets(const Vec3& p, const Vec3& q, const Triangle& t)
{
    const int from = exact_volume_sign(t[0], t[1], t[2], p);
    const int to = exact_volume_sign(t[0], t[1], t[2], q);
    if (from * to > 0)
    {
        return false;
    }
    if (from != 0 || to != 0)
    {
        return have_no_opposites(exact_volume_sign(p, q, t[0], t[1]),
                                 exact_volume_sign(p, q, t[1], t[2]),
                                 exact_volume_sign(p, q, t[2], t[0]));
    }
    return has_area(t) ? edge_meets_in_plane(p, q, t)
                       : edges_meet(p, q, t[0], t[1]) || edges_meet(p, q, t[1], t[2]) ||
                             edges_meet(p, q, t[2], t[0]);
}

bool any_edge_meets(const Triangle& edges, const Triangle& other)
{
    return edge_meets(edges[0], edges[1], other) || edge_meets(edges[1], edges[2], other) ||
           edge_meets(edges[2], edges[0], other);
}

} // namespace

int exact_volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const std::array<Point<double>, 4> p{point_of(a), point_of(b), point_of(c), point_of(d)};
    const Point<double> u = difference(p[1], p[0]);
    const Point<double> v = difference(p[2], p[0]);
    const Point<double> w = difference(p[3], p[0]);
    const double volume = determinant(u, v, w);
    if (is_certain(volume, magnitude(u, v, w)))
    {
        return sign_of(volume);
    }
    const int unit_log2 = common_unit({p[0], p[1], p[2], p[3]});
    return determinant(exact_difference(p[1], p[0], unit_log2),
                       exact_difference(p[2], p[0], unit_log2),
                       exact_difference(p[3], p[0], unit_log2))
        .sign();
}

bool exactly_meet(const Vec3& from, const Vec3& to, const Triangle& triangle)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] =
            std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        if (std::max(from[axis], to[axis]) < low || high < std::min(from[axis], to[axis]))
        {
            return false;
        }
    }
    return edge_meets(from, to, triangle);
}

bool exactly_meet(const Triangle& first, const Triangle& second)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] = std::minmax({first[0][axis], first[1][axis], first[2][axis]});
        const auto [from, to] = std::minmax({second[0][axis], second[1][axis], second[2][axis]});
        if (high < from || to < low)
        {
            return false;
        }
    }
    return any_edge_meets(first, second) || any_edge_meets(second, first);
}

} // namespace tactus::test
