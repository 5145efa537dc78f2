// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/test_model.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <cstdint>

namespace tactus::test
{

/// Frames of one model under one hardship, with a random motion.
struct BracketTrial
{
    const TestModel& model;
    const FaceTree& tree; ///< Tree of the model, for the motion.
    const ToolOracle& oracle;
    Hardship hardship;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct BracketFigures
{
    /// L <= d <= U, budgets kept, and open answers explained. The error is that of exact answers,
    /// as a share of their bounds' width.
    TrialFigures bounded;
    std::uint64_t answered{0}; ///< Frames with an exact or separated answer.
    std::uint64_t exact{0};
    FrameFault seen{FrameFault::none};
};

/// Compares every frame with the oracle, and every kCheckedFrames the oracle's tree with brute
/// force.
[[nodiscard]] BracketFigures run_bracket_trial(const BracketTrial& trial);

inline constexpr std::uint32_t kCheckedFrames = 500;

/// One answer against the truth, the pair's object at `pose`: distance of the true value from the
/// middle of the bounds, in half widths; above 1 it is outside, and `text` names the face.
struct BracketVerdict
{
    double error{0.0};
    std::string text;
};
[[nodiscard]] BracketVerdict judge_bracket(const ToolOracle& oracle, const PairOutput& pair,
                                           const ObjectPose& pose);

/// Frames on the base mesh only, one for each of its faces: at the source vertex that is farthest
/// from this face among those it is nearest to. The true distance is 0, so a face's bound that is
/// too small makes L > 0, unless another face's bound covers the point.
[[nodiscard]] TrialFigures query_worst_points(const TestModel& model);

} // namespace tactus::test
