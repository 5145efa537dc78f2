// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/trial_figures.hpp"
#include "tests/stability/garbage_trial.hpp"

#include <cstdint>
#include <span>

namespace tactus::test
{

/// Those of garbage_kinds(), and what is wrong with rotations alone: none at all, turns of another
/// angle in each frame, and one turn that stays.
[[nodiscard]] std::span<const Garbage> rigid_garbage_kinds();

/// A box lies on a plate, pressed on it, is drawn round and turned, and again and again its device
/// sends garbage for a while. In each frame force and torque must be finite and within the device's
/// range; while their gain is not whole neither may change faster than the ramps of SafeState;
/// without a sample both are on their way to zero; the box never meets the plate, by exact
/// arithmetic; the fault is told, and all is well soon after. The error is the largest force or
/// torque by the largest allowed one.
[[nodiscard]] TrialFigures run_rigid_garbage_trial(const Garbage& garbage, std::uint32_t frames,
                                                   std::uint64_t seed);

} // namespace tactus::test
