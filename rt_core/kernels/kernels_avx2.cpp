// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

// Compiled for AVX2. Only the kernels_*.cpp are compiled for more than the base instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): read by the source below.
#define TACTUS_KERNEL_SET "avx2"
#include "rt_core/kernels/kernel_sets.hpp"
#include "rt_core/kernels/kernel_source.inc"

namespace tactus
{

constinit const Kernels kAvx2Kernels = kKernels;

} // namespace tactus
