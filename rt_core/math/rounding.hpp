// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <bit>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// The next float above a finite value, without libm.
[[nodiscard]] constexpr float next_up(float value) noexcept
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    if (value == 0.0F)
    {
        return std::bit_cast<float>(std::uint32_t{1});
    }
    return std::bit_cast<float>(value > 0.0F ? bits + 1 : bits - 1);
}

/// The least float not below a double within float's range; below, the largest not above it. Boxes
/// and error bounds are stored rounded outward.
[[nodiscard]] constexpr float round_up_to_float(double value) noexcept
{
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) < value ? next_up(nearest) : nearest;
}

[[nodiscard]] constexpr float round_down_to_float(double value) noexcept
{
    return -round_up_to_float(-value);
}

/// Factor that makes a length with a few roundings at least the true one.
inline constexpr double kRoundedUp = 1.0 + 1e-14;

/// Factors that make the root of a sum of three squares at most / at least the true one: it has
/// five roundings of 2^-53, and the square root halves those of the sum.
inline constexpr double kRootRoundedDown = 1.0 - 1e-15;
inline constexpr double kRootRoundedUp = 1.0 + 1e-15;

/// Generous factor for a length that must not be less than the true one and decides nothing, such
/// as a filter's bound or a motion that is taken off a certificate.
inline constexpr double kWidened = 1.0 + 1e-12;

/// Squared length of a face normal, from coordinates near 1, up to which it has lost bits; the face
/// is then so thin that its edges represent it.
inline constexpr double kLeastTrustedNormalSq = 1e-240;

} // namespace tactus
