// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::bench
{

/// Path of one device over a static model. The model is loaded and refined before the first frame,
/// so that only the force model determines the result.
struct ForceRun
{
    const Scene& scene;
    ToolSpec tool;
    std::vector<Vec3> goals_m; ///< Device positions in the model frame, one for each frame.
    std::size_t lead_in{0};    ///< Frames at the start that are not counted.
    Material material{};       ///< Material of the surface.
};

/// Results of the counted frames.
struct ForceTrace
{
    std::vector<ToolOutput> outputs;
    std::vector<double> planes; ///< Planes that the proxy evaluated (Budgets::planes).
    LeastTimes force_us;        ///< Time of the force stage.
    LeastTimes frame_us;        ///< Time of all stages.
    /// Most allocations of all frames in one replay; empty if they cannot be counted.
    std::optional<std::uint64_t> allocations;
    std::uint64_t hash{0}; ///< Hash of the bits of all forces and proxies.
};

/// Replays the path `passes` times, at least once, each time with a new controller. A failure if
/// the model cannot be refined fully, or if two replays differ in a bit of a force.
[[nodiscard]] ForceTrace replay_forces(const ForceRun& run, std::uint32_t passes);

} // namespace tactus::bench
