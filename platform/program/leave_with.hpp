// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

namespace tactus::hrtc
{

/// Why a run that a signal ended can't be judged.
[[nodiscard]] Refusal interruption();

/// Logs it as an error of hrtc; returns the code to leave with.
int leave_with(const Refusal& error);

} // namespace tactus::hrtc
