// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/tool_core.hpp"
#include "tests/shared/trial_figures.hpp"

#include <cstdint>
#include <span>

namespace tactus::test
{

/// A kind of tool for which there is no room.
struct CrampedTool
{
    const char* name;
    ToolCore core;
    double radius_m{0.0};
    double smooth_m{0.0};                     ///< As ToolSpec has it.
    bool passes_through{false};               ///< It measures, and has no force.
    double angular_stiffness_nm_per_rad{0.0}; ///< As ToolSpec has it.
};

/// Every kind, with a radius and without one, and cores that are no more than a point, a line or a
/// plane. A mesh is of model 1.
[[nodiscard]] std::span<const CrampedTool> cramped_tools();

/// Episodes of 200 frames among objects that leave a tool no room or next to none: a plate that is
/// thinner than the tool's skin, gaps and wedges that are narrower than the tool, a corner, objects
/// that close in on it, and objects that come and go. Its hand rests on faces, in them, in the
/// middle of them and as far from them as the tool is wide, moves exactly along them, presses, and
/// jumps. In each frame force and torque are finite and within the device's range, and the proxy is
/// somewhere; a failed assertion ends the program with the seed of the episode. The error is the
/// largest force by the largest allowed one.
[[nodiscard]] TrialFigures run_no_room_trial(const CrampedTool& tool, bool has_friction,
                                             std::uint32_t frames, std::uint64_t seed);

} // namespace tactus::test
