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

/// Every counter of a frame with one model and one pair against its budget, every pool against its
/// size. The refinement asks two questions at most and the query one; each has the whole budget of
/// nodes and triangles.
[[nodiscard]] Verdict broken_budget(const FrameOutput& output, const Budgets& budgets);

/// A question that is left open although nothing is said to have run out, or a model that
/// contradicts itself.
[[nodiscard]] Verdict unexplained(const FrameOutput& output);

} // namespace tactus::test
