// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <bit>
#include <cstdint>

namespace tactus
{

/// The next float below / above a finite value, without libm.
[[nodiscard]] constexpr float next_up(float value) noexcept
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    if (value == 0.0F)
    {
        return std::bit_cast<float>(std::uint32_t{1});
    }
    return std::bit_cast<float>(value > 0.0F ? bits + 1 : bits - 1);
}

[[nodiscard]] constexpr float next_down(float value) noexcept
{
    return -next_up(-value);
}

/// The least float not below / largest float not above a double within float's range: boxes and
/// error bounds are stored rounded outward.
[[nodiscard]] constexpr float round_up_to_float(double value) noexcept
{
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) < value ? next_up(nearest) : nearest;
}

[[nodiscard]] constexpr float round_down_to_float(double value) noexcept
{
    return -round_up_to_float(-value);
}

/// A length of some roundings, multiplied by this, is at least the true one.
inline constexpr double kRoundedUp = 1.0 + 1e-14;

} // namespace tactus
