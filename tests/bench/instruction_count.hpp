// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"
#include "tests/shared/frame_rig.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::bench
{

/// rig.step_without_delivery(): a frame that is measured, under a name by which callgrind finds it.
/// Its T_R + T_B lie between two calls with names of their own.
[[nodiscard]] FrameOutput counted_step(test::FrameRig& rig, const std::vector<Vec3>& goals_m,
                                       const Budgets& budgets, StageMark mark);

/// Instructions of all calls of counted_step() when the case runs once by itself with --count, in
/// another process of this program under valgrind's callgrind; some 50 times as long as without.
/// None unless --instructions asks for it, nor in that process itself. A failure when there is no
/// valgrind, or it fails.
[[nodiscard]] std::optional<std::uint64_t> count_instructions(const CaseContext& context);

/// The same, of T_R + T_B alone and call by call.
[[nodiscard]] std::vector<double> count_refinements(const CaseContext& context);

} // namespace tactus::bench
