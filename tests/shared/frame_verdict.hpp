// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <optional>
#include <string>

namespace tactus::test
{

/// What is wrong with a frame, in a line; nothing when it is as it should be.
using Verdict = std::optional<std::string>;

/// Every counter of a frame against its budget, every pool against its size. Refinement and answers
/// have kFrameWalks budgets of nodes and triangles each. A tool that is a mesh may look at its
/// object, and that at the tool, at two places, with kMeshRefineFactor times the budget each, at
/// the object for its cover once more, and for its query with kMeshBudgetFactor times the budget.
[[nodiscard]] Verdict broken_budget(const FrameOutput& output, const Budgets& budgets);

/// A question that is left open although nothing is said to have run out, or a model that
/// contradicts itself.
[[nodiscard]] Verdict unexplained(const FrameOutput& output);

} // namespace tactus::test
