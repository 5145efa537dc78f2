// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/tool_core.hpp"
#include "tests/shared/trial_figures.hpp"

#include <cstdint>
#include <span>

namespace tactus::test
{

/// Kind of tool with too little free space.
struct CrampedTool
{
    const char* name;
    ToolCore core;
    double radius_m{0.0};
    double shading_m{0.0};                    ///< See ToolSpec.
    bool query_only{false};                   ///< True for a query-only tool without force.
    double angular_stiffness_nm_per_rad{0.0}; ///< See ToolSpec.
};

/// Tools of every kind, with and without a radius, and cores that degenerate to a point, a line or
/// a plane. A mesh is model 1.
[[nodiscard]] std::span<const CrampedTool> cramped_tools();

/// Episodes of 200 frames among objects that leave a tool little or no space: a plate thinner than
/// the tool's skin, gaps and wedges narrower than the tool, a corner, objects that close in, and
/// objects that are added and removed. The hand rests on faces, in them, in their middle and at the
/// tool's width from them, moves exactly along them, presses, and jumps. In each frame force and
/// torque are finite and within the device's range, and the proxy is finite; a failed assertion
/// ends the program with the seed of the episode. The error is the greatest force divided by the
/// allowed one.
[[nodiscard]] TrialFigures run_no_room_trial(const CrampedTool& tool, bool has_friction,
                                             std::uint32_t frames, std::uint64_t seed);

} // namespace tactus::test
