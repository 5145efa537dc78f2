// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

namespace tactus::hrtc
{

/// Refusal of a result for a run that a signal has ended.
[[nodiscard]] Refusal interruption();

/// Logs `error` as an error of hrtc. Returns the exit code.
int leave_with(const Refusal& error);

} // namespace tactus::hrtc
