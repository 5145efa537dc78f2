// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Error bounds are stored as one byte: 0 is "exact", code c > 0 is 2^((c - 1) / 4 - 8) quanta,
/// rounded up. The smallest bound is 1/256 of a quantum, the largest (code 255) 2^55.5 quanta.
using ErrorCode = std::uint8_t;

namespace detail
{

/// 2^(k/4) rounded up to float.
// NOLINTBEGIN(modernize-use-std-numbers): in float the constant is not rounded up.
inline constexpr std::array<float, 4> kQuarterPowers{1.0F, next_up(1.189207115F),
                                                     next_up(1.414213562F), next_up(1.681792831F)};
// NOLINTEND(modernize-use-std-numbers)

constexpr std::array<float, 256> make_error_quanta() noexcept
{
    std::array<float, 256> table{};
    float octave = 1.0F / 256.0F;
    for (std::size_t code = 1; code < table.size(); ++code)
    {
        const std::size_t quarter = (code - 1) % 4;
        table[code] = octave * detail::kQuarterPowers[quarter];
        octave = quarter == 3 ? octave * 2.0F : octave;
    }
    return table;
}

inline constexpr std::array<float, 256> kErrorQuanta = make_error_quanta();
static_assert(std::ranges::is_sorted(kErrorQuanta), "a larger code is a larger bound");
static_assert(kErrorQuanta[1] == 1.0F / 256.0F);

} // namespace detail

/// Bound of a code, in quanta. Exactly 0 for code 0.
[[nodiscard]] constexpr float error_in_quanta(ErrorCode code) noexcept
{
    return detail::kErrorQuanta[code];
}

/// The least code, at least 1, whose bound is not below `quanta`; 255 holds every mesh's extent
/// (at most 2^24.8 quanta).
[[nodiscard]] constexpr ErrorCode encode_error(double quanta) noexcept
{
    std::uint32_t code = 1;
    for (std::uint32_t step = 128; step > 0; step /= 2)
    {
        // All codes below `code + step` are too small; the bound of 255 is never checked.
        if (code + step <= 255 &&
            static_cast<double>(detail::kErrorQuanta[code + step - 1]) < quanta)
        {
            code += step;
        }
    }
    return static_cast<ErrorCode>(code);
}

/// The largest code whose bound is not above `quanta`: 0 below the smallest.
[[nodiscard]] constexpr ErrorCode largest_code_within(double quanta) noexcept
{
    const ErrorCode code = encode_error(quanta);
    return static_cast<double>(error_in_quanta(code)) <= quanta ? code
                                                                : static_cast<ErrorCode>(code - 1);
}

} // namespace tactus
