// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/work_counters.hpp"
#include "tests/bench/frame_replay.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// What the frames of one replay answered and did; no times.
struct FrameTrace
{
    std::vector<PairOutput> pairs; ///< Of the first pair, of each counted frame.
    WorkCounters work;             ///< Of the counted frames.
    std::uint64_t coded_bytes{0};  ///< That came over the link meanwhile.
    ModelOutput model;             ///< After the last frame.
};

/// Runs the frames once.
[[nodiscard]] FrameTrace trace_frames(const FrameRun& run);

} // namespace tactus::bench
