// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_output.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Query-only mesh tool, which follows the device pose and renders no force.
struct PairRun
{
    const Scene& tool;
    const Scene& object;
    std::vector<ToolState> places; ///< Poses in the frame of the object's model.
    double radius_m{0.0};          ///< Radius within which distances must be exact.
    double speed_m_per_s{0.0};     ///< Greatest speed of a point of the tool.
    std::size_t pool_bytes{0};     ///< Pools of both models.
    bool is_static{false};         ///< Both models are resident and refined before the first pose.
};

/// Times and answers of the frames of a run.
struct PairFrames
{
    std::array<LeastTimes, kStages> stage_us;
    LeastTimes sum_us; ///< T = T_R + T_B + T_Q + T_L.
    std::vector<PairOutput> answers;
    WorkCounters work;
    std::uint32_t active_faces{0}; ///< Most active faces of the object.
    std::uint64_t meeting_pairs{0};
    std::uint64_t hash{0}; ///< Hash of answers and states.
};

/// Replays a run `passes` times, after some frames at its first pose. A failure if passes differ.
[[nodiscard]] PairFrames replay_pair(const PairRun& run, std::uint32_t passes);

} // namespace tactus::bench
