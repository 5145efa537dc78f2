// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

// Compiled for AVX2. Only the kernels_*.cpp are compiled for more than the base instruction set.
#define TACTUS_KERNEL_SET "avx2"
#include "rt_core/kernels/kernel_sets.hpp"
#include "rt_core/kernels/kernel_source.inc"

namespace tactus
{

const Kernels& avx2_kernels() noexcept
{
    return kKernels;
}

} // namespace tactus
