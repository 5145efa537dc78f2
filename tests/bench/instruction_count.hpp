// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"
#include "tests/shared/frame_rig.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::bench
{

/// Calls rig.step_without_delivery() under a name that callgrind finds. The stages end at calls
/// with names of their own.
[[nodiscard]] FrameOutput counted_step(test::FrameRig& rig, std::span<const ToolState> tools,
                                       const Budgets& budgets, StageMark mark);
[[nodiscard]] FrameOutput counted_step(test::FrameRig& rig, const std::vector<Vec3>& goals_m,
                                       const Budgets& budgets, StageMark mark);

/// Instructions of all calls of counted_step() when the case runs once by itself with --count, in
/// another process of this program under valgrind's callgrind, about 50 times slower. Empty without
/// --instructions and in that process itself. A failure if valgrind is missing or fails.
[[nodiscard]] std::optional<std::uint64_t> count_instructions(const CaseContext& context);

/// Counts of one frame, by Stage.
using StageCounts = std::array<std::uint64_t, kStages>;
/// Instructions by call and stage.
[[nodiscard]] std::vector<StageCounts> count_stages(const CaseContext& context);

} // namespace tactus::bench
