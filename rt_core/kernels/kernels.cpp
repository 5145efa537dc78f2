// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/kernels/kernels.hpp"

#include "rt_core/kernels/kernel_sets.hpp"

#include <array>

namespace tactus
{

const Kernels& portable_kernels() noexcept
{
    return kPortableKernels;
}

#ifdef TACTUS_HAS_X86_KERNELS

std::span<const Kernels* const> available_kernels() noexcept
{
    static constexpr std::array<const Kernels*, 2> kAll{&kPortableKernels, &kAvx2Kernels};
    // NOLINTNEXTLINE(readability-redundant-casting): an int with g++.
    const bool has_avx2 = static_cast<bool>(__builtin_cpu_supports("avx2"));
    return std::span(kAll).first(has_avx2 ? 2 : 1);
}

#else

std::span<const Kernels* const> available_kernels() noexcept
{
    static constexpr std::array<const Kernels*, 1> kAll{&kPortableKernels};
    return kAll;
}

#endif

} // namespace tactus
