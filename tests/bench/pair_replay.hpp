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

/// A tool that is a mesh and measures: it is where it is put, and feels nothing.
struct PairRun
{
    const Scene& tool;
    const Scene& object;
    std::vector<ToolState> places; ///< In the object's model's frame.
    double radius_m{0.0};          ///< Distances up to this are to be exact.
    double speed_m_per_s{0.0};     ///< No point of the tool is faster.
    std::size_t pool_bytes{0};     ///< Of both models.
    bool is_static{false};         ///< Both are there as a whole before the first place.
};

/// What the frames of a run took and said.
struct PairFrames
{
    std::array<LeastTimes, kStages> stage_us;
    LeastTimes sum_us; ///< T = T_R + T_B + T_Q + T_L.
    std::vector<PairOutput> answers;
    WorkCounters work;              ///< Of all frames.
    std::uint32_t active_faces{0};  ///< Of the object, at most.
    std::uint64_t meeting_pairs{0}; ///< In all frames.
    std::uint64_t hash{0};          ///< Over answers and states.
};

/// Replays a run so many times from its start, after some frames at its first place. A failure
/// when passes differ.
[[nodiscard]] PairFrames replay_pair(const PairRun& run, std::uint32_t passes);

} // namespace tactus::bench
