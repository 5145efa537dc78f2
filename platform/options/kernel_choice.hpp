// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "transport/base/refusal.hpp"

#include <span>
#include <string_view>

namespace tactus::hrtc
{

/// Kernels of this name among those that the processor supports (available_kernels()). The refusal
/// of another name lists the available ones.
[[nodiscard]] Result<const Kernels*, Refusal>
choose_kernels(std::string_view name, std::span<const Kernels* const> available);

} // namespace tactus::hrtc
