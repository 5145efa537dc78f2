// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/double_double.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tactus
{

/// The exact value of a sum, difference or product of doubles: a sum of at most `Capacity` doubles
/// without common bits, the smallest first, none of them zero (Priest's and Shewchuk's floating
/// expansions). Exact as long as no bit overflows or falls below the smallest double.
template <std::size_t Capacity>
class Expansion
{
public:
    // NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): terms are written before they are read.
    Expansion() noexcept {} // NOLINT(modernize-use-equals-default): `= default` would zero them.
    explicit Expansion(const DoubleDouble& value) noexcept
    {
        push(value.low);
        push(value.high);
    }
    // NOLINTEND(cppcoreguidelines-pro-type-member-init)

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] double operator[](std::size_t i) const noexcept { return term_[i]; }

    void push(double term) noexcept
    {
        if (term != 0.0)
        {
            TACTUS_ASSERT(size_ < Capacity);
            term_[size_++] = term;
        }
    }

    /// Sign of the value, -1, 0 or 1: that of the last term, which is larger than the sum of the
    /// others.
    [[nodiscard]] int sign() const noexcept
    {
        return size_ == 0 ? 0 : (term_[size_ - 1] > 0.0 ? 1 : -1);
    }

    /// The value within two units in the last place.
    [[nodiscard]] double rounded() const noexcept
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < size_; ++i)
        {
            sum += term_[i];
        }
        return sum;
    }

private:
    std::array<double, Capacity> term_;
    std::size_t size_{0};
};

/// The exact sum: both are merged in order of size, and each rounding error becomes a term.
template <std::size_t N, std::size_t M>
[[nodiscard]] Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) noexcept
{
    Expansion<N + M> result;
    double carry = 0.0;
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size())
    {
        const bool from_a = j == b.size() || (i < a.size() && std::abs(a[i]) < std::abs(b[j]));
        const DoubleDouble sum = two_sum(carry, from_a ? a[i++] : b[j++]);
        result.push(sum.low);
        carry = sum.high;
    }
    result.push(carry);
    return result;
}

template <std::size_t N>
[[nodiscard]] Expansion<2 * N> operator*(const Expansion<N>& a, double factor) noexcept
{
    Expansion<2 * N> result;
    double carry = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const DoubleDouble product = two_product(a[i], factor);
        const DoubleDouble lower = two_sum(carry, product.low);
        const DoubleDouble upper = two_sum_sorted(product.high, lower.high);
        result.push(lower.low);
        result.push(upper.low);
        carry = upper.high;
    }
    result.push(carry);
    return result;
}

template <std::size_t N>
[[nodiscard]] Expansion<4 * N> operator*(const Expansion<N>& a, const DoubleDouble& b) noexcept
{
    return a * b.low + a * b.high;
}

} // namespace tactus
