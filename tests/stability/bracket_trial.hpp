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
    const FaceTree& tree;     ///< Of the model, for the motion.
    const ToolOracle& oracle; ///< Of the tool.
    Hardship hardship;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct BracketFigures
{
    /// L <= d <= U, budgets kept, and open questions explained; the error is that of exact answers,
    /// as a share of what their bracket allows.
    TrialFigures bracket;
    std::uint64_t answered{0}; ///< Exact or decided.
    std::uint64_t exact{0};
    FrameFault seen{FrameFault::none};
};

/// Every frame against the oracle; every kCheckedFrames the oracle's tree against brute force.
[[nodiscard]] BracketFigures run_bracket_trial(const BracketTrial& trial);

inline constexpr std::uint32_t kCheckedFrames = 500;

/// One answer against the truth, the pair's object at `pose`: how far the true distance is from the
/// bracket's middle, in half widths; above 1 it is outside. `text` names the face then.
struct BracketVerdict
{
    double error{0.0};
    std::string text;
};
[[nodiscard]] BracketVerdict judge_bracket(const ToolOracle& oracle, const PairOutput& pair,
                                           const ObjectPose& pose);

/// Frames that see the base mesh only, each at the vertex of the source that is farthest from the
/// face of the base mesh that is nearest to it: one a face. The true distance is 0, so a face's
/// bound that is too small makes L > 0, unless another face's covers the point.
[[nodiscard]] TrialFigures query_worst_points(const TestModel& model);

} // namespace tactus::test
