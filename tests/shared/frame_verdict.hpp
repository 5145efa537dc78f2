// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <optional>
#include <string>

namespace tactus::test
{

/// Fault of a frame, in one line; empty if there is none.
using Verdict = std::optional<std::string>;

/// Compares every counter of a frame with its budget, every pool with its size. Refinement and
/// answers have kFrameWalks budgets of nodes and triangles each. A mesh tool may search its object,
/// and that the tool, at two places, with kMeshRefineFactor times the budget each, the object once
/// more for its cover, and for its query with kMeshBudgetFactor times the budget.
[[nodiscard]] Verdict broken_budget(const FrameOutput& output, const Budgets& budgets);

/// Open answer without a reported shortage, or a model that contradicts itself.
[[nodiscard]] Verdict unexplained(const FrameOutput& output);

} // namespace tactus::test
