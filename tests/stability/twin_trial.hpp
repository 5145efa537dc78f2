// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <cstdint>

namespace tactus::test
{

/// The same model twice: streamed and refined around a sliding tool as in use, and refined fully.
struct TwinTrial
{
    const TestModel& model;
    const FaceTree& tree;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct TwinFigures
{
    /// Certified frames: kind, L, U, nearest face, point and feature, and the set of exact faces
    /// within the certified radius, bit for bit. The error is the number of differences.
    TrialFigures identity;
    /// Point, segment, box and hull in turn in those frames, at the centre of the sphere: contacts
    /// and, of exact answers, normal, side and nearest points, bit for bit.
    TrialFigures cores;
    /// Frames without an exact or separated answer, after the tool's descent, with K = 64 at 0.1
    /// diag/s. The error is their share.
    TrialFigures uncertified;
};

/// Share of frames that may be open.
inline constexpr double kUncertifiedShare = 0.05;

[[nodiscard]] TwinFigures run_twin_trial(const TwinTrial& trial);

} // namespace tactus::test
