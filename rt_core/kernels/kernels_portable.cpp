// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#define TACTUS_KERNEL_SET "portable"
#include "rt_core/kernels/kernel_source.inc"

namespace tactus
{

const Kernels& portable_kernels() noexcept
{
    return kKernels;
}

} // namespace tactus
