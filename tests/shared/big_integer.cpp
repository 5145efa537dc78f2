// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/big_integer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tactus::test
{

namespace
{

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

} // namespace

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

} // namespace tactus::test
