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
    /// Touches, after each of which the tool rests far away: state hash and pools are those of the
    /// start, the proxy is the goal to the last bit, and there is no force.
    TrialFigures returns;
    /// Of a proxy that is pressed against the surface, over the tolerance of contact. Counts
    /// touches.
    TrialFigures creep;
    std::uint64_t frames{0};
    double simulated_s{0.0};
};

/// A day's work: touches of kTouchFrames frames of 1 ms, in a cycle of some different ones.
[[nodiscard]] DayFigures run_day_trial(const TestModel& model, std::uint32_t touches,
                                       std::uint64_t seed);

inline constexpr std::uint32_t kTouchFrames = 2'000;

/// One press that lasts `frames`; the figure is its creep.
[[nodiscard]] TrialFigures run_press_trial(const TestModel& model, std::uint64_t frames,
                                           std::uint64_t seed);

/// Random splits, each with its closure, and merges, in waves between base and source. After each
/// wave everything is merged: then hash, faces, records and tree must be those of the start. Counts
/// operations.
[[nodiscard]] TrialFigures run_split_merge_trial(const TestModel& model, std::uint64_t operations,
                                                 std::uint64_t seed);

} // namespace tactus::test
