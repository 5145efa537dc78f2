// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <vector>

namespace tactus::test
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

/// Exponent of the lowest bit of a finite number; the largest int for 0.
[[nodiscard]] int lowest_bit_log2(double value);

} // namespace tactus::test
