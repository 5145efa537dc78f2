// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/kernels/kernels.hpp"

#if defined(TACTUS_HAS_X86_KERNELS)
#include "rt_core/kernels/kernel_sets.hpp"
#endif

namespace tactus
{

#if defined(TACTUS_HAS_X86_KERNELS)

std::span<const Kernels> available_kernels() noexcept
{
    static const std::array<Kernels, 2> kAll{portable_kernels(), avx2_kernels()};
    return std::span(kAll).first(__builtin_cpu_supports("avx2") != 0 ? 2 : 1);
}

#else

std::span<const Kernels> available_kernels() noexcept
{
    return {&portable_kernels(), 1};
}

#endif

} // namespace tactus
