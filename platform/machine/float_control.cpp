// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/float_control.hpp"

#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace tactus
{

bool reset_float_control() noexcept
{
#if defined(__x86_64__)
    constexpr std::uint32_t kDefault = 0x1F80;   // All exceptions are masked, all other bits are 0.
    constexpr std::uint32_t kRaisedFlags = 0x3F; // Status flags; not settings.
    const std::uint32_t found = _mm_getcsr();
    _mm_setcsr(kDefault);
    return (found & ~kRaisedFlags) == kDefault;
#elif defined(__aarch64__)
    std::uint64_t found = 0;
    __asm__ volatile("mrs %0, fpcr" : "=r"(found));
    __asm__ volatile("msr fpcr, %0" : : "r"(std::uint64_t{0}));
    return found == 0;
#else
    return true;
#endif
}

} // namespace tactus
