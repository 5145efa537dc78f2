// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"

namespace tactus
{

/// Kernel sets for kernels.cpp, from the sources that are compiled once for each instruction set.
/// Only data: even a function that returns them would be compiled for that set.
extern const Kernels kPortableKernels;
extern const Kernels kAvx2Kernels; ///< Only with TACTUS_HAS_X86_KERNELS.

} // namespace tactus
