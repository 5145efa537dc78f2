// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"

namespace tactus
{

/// What the sources that are compiled for more than the base instruction set offer to kernels.cpp.
/// To be called on processors that have it.
[[nodiscard]] const Kernels& avx2_kernels() noexcept;

} // namespace tactus
