// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <cstdint>

namespace tactus::test
{

/// The same model twice: streamed and refined round a sliding tool as in use, and refined fully.
struct TwinTrial
{
    const TestModel& model;
    const FaceTree& tree;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct TwinFigures
{
    /// Of every certified frame: kind, L, U, nearest face, point and feature, and the set of exact
    /// faces within the certified radius, bit for bit. The error is the number of differences.
    TrialFigures identity;
    /// In those frames a point, a segment, a box and a hull in turn, in the middle of the ball:
    /// contacts and, of exact answers, normal, side and nearest points, bit for bit.
    TrialFigures cores;
    /// Frames without an exact or decided answer, of those after the tool has come down, with K =
    /// 64 at 0.1 diag/s. The error is their share.
    TrialFigures uncertified;
};

/// What of an answer may be left open: a twentieth of the frames.
inline constexpr double kUncertifiedShare = 0.05;

[[nodiscard]] TwinFigures run_twin_trial(const TwinTrial& trial);

} // namespace tactus::test
