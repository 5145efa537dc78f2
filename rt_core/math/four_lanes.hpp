// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace tactus
{

/// Vectors of 16 bytes, which every supported target has, for small loops outside the kernels.
using FourFloats = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

/// One bit per lane; each lane is all ones or all zeros.
[[nodiscard]] inline std::uint32_t bits_of(FourInts lanes) noexcept
{
#ifdef __SSE2__
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(lanes)));
#else
    return static_cast<std::uint32_t>((lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) |
                                      (lanes[3] & 8));
#endif
}

} // namespace tactus
