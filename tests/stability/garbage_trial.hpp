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

/// Faulty samples of a broken device.
struct Garbage
{
    const char* name;
    /// Makes one from a sound sample; `good` is the last one before the episode.
    void (*spoil)(ToolState& sample, const ToolState& good, Random& random);
    FrameFault fault;         ///< Fault that the first frame must report.
    FrameFault lasting_fault; ///< Fault that frames after kSampleHold_s must report.
    bool fades{false};        ///< True if the frame has no usable sample.
};

inline constexpr std::size_t kGarbageKinds = 9;
[[nodiscard]] const std::array<Garbage, kGarbageKinds>& garbage_kinds();

/// A tool slides over the surface, pressed against it, while its device repeatedly sends garbage.
/// In each frame the force must be finite, within the device's range and, without a sample, fading
/// to zero; the proxy finite; L <= d <= U; the fault reported; and everything as before soon after.
/// The error is the greatest force divided by the allowed one.
[[nodiscard]] TrialFigures run_garbage_trial(const TestModel& model, const CenterOracle& oracle,
                                             const Garbage& garbage, std::uint32_t frames,
                                             std::uint64_t seed);

/// The kinds of garbage_kinds(), and faults of the rotation alone: invalid, another angle in each
/// frame, and one rotation that stays.
[[nodiscard]] std::span<const Garbage> rigid_garbage_kinds();

/// A box lies on a plate, pressed on it, is dragged around and rotated, while its device repeatedly
/// sends garbage. In each frame force and torque must be finite and within the device's range;
/// while their gain is below one neither may change faster than the ramps of ForceFader; without a
/// sample both fade to zero; the box never meets the plate, by exact arithmetic; the fault is
/// reported and everything recovers soon after. The error is the greatest force or torque divided
/// by the allowed one.
[[nodiscard]] TrialFigures run_rigid_garbage_trial(const Garbage& garbage, std::uint32_t frames,
                                                   std::uint64_t seed);

} // namespace tactus::test
