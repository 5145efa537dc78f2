// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace tactus
{

/// Lanes of 16 bytes, which every target of ours has: for small loops outside the kernels.
using FourFloats = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using EightShorts = std::int16_t __attribute__((vector_size(16)));
using EightUnsigned = std::uint16_t __attribute__((vector_size(16)));

/// One bit a lane, of lanes that are all ones or all zeros.
[[nodiscard]] inline std::uint32_t bits_of(FourInts lanes) noexcept
{
#ifdef __SSE2__
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(lanes)));
#else
    return static_cast<std::uint32_t>((lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) |
                                      (lanes[3] & 8));
#endif
}

/// What each lane of `a` is above that of `b`, or zero.
[[nodiscard]] inline EightUnsigned excess(EightUnsigned a, EightUnsigned b) noexcept
{
#ifdef __SSE2__
    return reinterpret_cast<EightUnsigned>(
        _mm_subs_epu16(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
#else
    return a > b ? a - b : EightUnsigned{};
#endif
}

[[nodiscard]] inline std::uint32_t bits_of(EightShorts lanes) noexcept
{
#ifdef __SSE2__
    const auto all = reinterpret_cast<__m128i>(lanes);
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(all, all))) & 0xffU;
#else
    std::uint32_t bits = 0;
    for (std::uint32_t lane = 0; lane < 8; ++lane)
    {
        bits |= (lanes[lane] & 1U) << lane;
    }
    return bits;
#endif
}

} // namespace tactus
