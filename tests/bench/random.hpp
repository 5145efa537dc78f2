// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus::bench
{

/// The seed of every noise and motion here; it stands in the rows.
inline constexpr std::uint64_t kSeed = 2026;

/// A well-mixed 64-bit number for each index: the same in every run and on every machine.
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t seed, std::uint64_t index)
{
    std::uint64_t bits = (seed + 1) * 0x9E37'79B9'7F4A'7C15ULL + index * 0xD1B5'4A32'D192'ED03ULL;
    bits = (bits ^ (bits >> 32U)) * 0xBF58'476D'1CE4'E5B9ULL;
    bits = (bits ^ (bits >> 29U)) * 0x94D0'49BB'1331'11EBULL;
    return bits ^ (bits >> 32U);
}

/// Uniform in -1 .. 1.
[[nodiscard]] constexpr double signed_unit(std::uint64_t seed, std::uint64_t index)
{
    return static_cast<double>(mixed(seed, index) >> 11U) * 0x1p-52 - 1.0;
}

} // namespace tactus::bench
