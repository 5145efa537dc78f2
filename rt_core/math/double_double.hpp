// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// The unevaluated sum of two doubles, `low` at most half a unit in the last place of `high`: about
/// 106 bits. Sums and products err by less than 2^-102 of the operands' size (for a sum: of the
/// addends' size, even if they cancel), as long as nothing overflows or falls below 1e-290.
///
/// Plain x86-64 has no FMA: a sum costs about 11 operations, a product 25.
struct DoubleDouble
{
    double high{0.0};
    double low{0.0};

    friend constexpr bool operator==(const DoubleDouble&, const DoubleDouble&) noexcept = default;
    friend constexpr bool operator<(const DoubleDouble& a, const DoubleDouble& b) noexcept
    {
        return a.high < b.high || (a.high == b.high && a.low < b.low);
    }
    friend constexpr bool operator>(const DoubleDouble& a, const DoubleDouble& b) noexcept
    {
        return b < a;
    }
};

/// a + b, exactly, where |a| >= |b| or a = 0.
[[nodiscard]] constexpr DoubleDouble two_sum_sorted(double a, double b) noexcept
{
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

/// a + b, exactly (Knuth).
[[nodiscard]] constexpr DoubleDouble two_sum(double a, double b) noexcept
{
    const double sum = a + b;
    const double of_b = sum - a;
    const double of_a = sum - of_b;
    return {sum, (a - of_a) + (b - of_b)};
}

[[nodiscard]] constexpr DoubleDouble two_difference(double a, double b) noexcept
{
    return two_sum(a, -b);
}

/// Upper and lower 26 bits (Veltkamp). Overflows beyond 1e300.
[[nodiscard]] constexpr DoubleDouble split_in_halves(double a) noexcept
{
    const double spread = 0x1.0000002p27 * a;
    const double high = spread - (spread - a);
    return {high, a - high};
}

/// a x b, exactly (Dekker), unless bits of it fall below the smallest double.
[[nodiscard]] constexpr DoubleDouble two_product(double a, double b) noexcept
{
    const double product = a * b;
    const DoubleDouble p = split_in_halves(a);
    const DoubleDouble q = split_in_halves(b);
    const double rest = ((p.high * q.high - product) + p.high * q.low) + p.low * q.high;
    return {product, rest + p.low * q.low};
}

[[nodiscard]] constexpr DoubleDouble operator-(const DoubleDouble& a) noexcept
{
    return {-a.high, -a.low};
}

[[nodiscard]] constexpr DoubleDouble operator+(const DoubleDouble& a,
                                               const DoubleDouble& b) noexcept
{
    const DoubleDouble sum = two_sum(a.high, b.high);
    return two_sum_sorted(sum.high, sum.low + (a.low + b.low));
}

[[nodiscard]] constexpr DoubleDouble operator-(const DoubleDouble& a,
                                               const DoubleDouble& b) noexcept
{
    return a + -b;
}

[[nodiscard]] constexpr DoubleDouble operator*(const DoubleDouble& a,
                                               const DoubleDouble& b) noexcept
{
    const DoubleDouble product = two_product(a.high, b.high);
    return two_sum_sorted(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// b must not be zero.
[[nodiscard]] constexpr DoubleDouble operator/(const DoubleDouble& a,
                                               const DoubleDouble& b) noexcept
{
    const double first = a.high / b.high;
    const DoubleDouble rest = a - b * DoubleDouble{first};
    const double second = rest.high / b.high;
    const DoubleDouble rest_of_rest = rest - b * DoubleDouble{second};
    const DoubleDouble quotient = two_sum_sorted(first, second);
    return quotient + DoubleDouble{rest_of_rest.high / b.high};
}

[[nodiscard]] constexpr double to_double(double value) noexcept
{
    return value;
}
[[nodiscard]] constexpr double to_double(const DoubleDouble& value) noexcept
{
    return value.high;
}

} // namespace tactus
