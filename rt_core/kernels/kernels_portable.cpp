// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): read by the source below.
#define TACTUS_KERNEL_SET "portable"
#include "rt_core/kernels/kernel_sets.hpp"
#include "rt_core/kernels/kernel_source.inc"

namespace tactus
{

constinit const Kernels kPortableKernels = kKernels;

} // namespace tactus
