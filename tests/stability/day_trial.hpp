// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/test_model.hpp"
#include "tests/shared/trial_figures.hpp"

#include <cstdint>

namespace tactus::test
{

struct DayFigures
{
    /// After each touch the tool rests far away: state hash and pools are those of the start, the
    /// proxy equals the goal to the last bit, and there is no force.
    TrialFigures returns;
    /// Creep of a proxy that is pressed against the surface, relative to the contact tolerance.
    /// Counts touches.
    TrialFigures creep;
    std::uint64_t frames{0};
    double simulated_s{0.0};
};

/// A day's work: touches of kTouchFrames frames of 1 ms, in a cycle of a few different ones.
[[nodiscard]] DayFigures run_day_trial(const TestModel& model, std::uint32_t touches,
                                       std::uint64_t seed);

inline constexpr std::uint32_t kTouchFrames = 2'000;

/// One press that lasts `frames`; the figure is its creep.
[[nodiscard]] TrialFigures run_press_trial(const TestModel& model, std::uint64_t frames,
                                           std::uint64_t seed);

/// Random splits, each with its closure, and merges, in waves between base and source. After each
/// wave everything is merged: hash, faces, records and tree must then be those of the start. Counts
/// operations.
[[nodiscard]] TrialFigures run_split_merge_trial(const TestModel& model, std::uint64_t operations,
                                                 std::uint64_t seed);

} // namespace tactus::test
