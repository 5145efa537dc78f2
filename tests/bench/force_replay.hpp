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

/// One device's way over a static model: all of it loaded and refined before the first frame, so
/// that nothing but the force model decides what is felt.
struct ForceRun
{
    const Scene& scene;
    ToolSpec tool;
    std::vector<Vec3> goals_m; ///< In the model's frame; one a frame.
    std::size_t lead_in{0};    ///< Frames at the start that are run and not counted.
    Material material{};       ///< The surface's.
};

/// What came of the counted frames.
struct ForceTrace
{
    std::vector<ToolOutput> outputs;
    std::vector<double> planes; ///< That the proxy looked at (Budgets::planes).
    LeastTimes force_us;        ///< Of the stage alone.
    LeastTimes frame_us;        ///< Of all stages.
    /// By all frames of the replay that had most; nothing where they can't be counted.
    std::optional<std::uint64_t> allocations;
    std::uint64_t hash{0}; ///< Over the bits of all forces and proxies.
};

/// Replays the way `passes` times, at least once, each time with a new controller. A failure when
/// the model can't be refined fully and when two replays give forces of different bits.
[[nodiscard]] ForceTrace replay_forces(const ForceRun& run, std::uint32_t passes);

} // namespace tactus::bench
