// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus::test
{

/// What a broken device may send instead of a sample.
struct Garbage
{
    const char* name;
    /// Makes it of a good sample; `good` is the last one before the episode.
    void (*spoil)(ToolState& sample, const ToolState& good, Random& random);
    FrameFault fault;         ///< What the frame must say in its first frame,
    FrameFault lasting_fault; ///< and what after kSampleHold_s.
    bool fades{false};        ///< It leaves the frame without a sample.
};

inline constexpr std::size_t kGarbageKinds = 9;
[[nodiscard]] const std::array<Garbage, kGarbageKinds>& garbage_kinds();

/// A tool slides over the surface, pressed against it, and again and again its device sends garbage
/// for a while. In each frame the force must be finite, within the device's range and, without a
/// sample, on its way to zero; the proxy finite, L <= d <= U; the fault told; and everything as
/// before soon after. The error is the largest force by the largest allowed one.
[[nodiscard]] TrialFigures run_garbage_trial(const TestModel& model, const CenterOracle& oracle,
                                             const Garbage& garbage, std::uint32_t frames,
                                             std::uint64_t seed);

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
