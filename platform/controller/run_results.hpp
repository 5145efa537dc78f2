// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording_format.hpp"

#include <cstdint>

namespace tactus::hrtc
{

/// Result of a recording, for the report.
struct RecordingResult
{
    std::uint64_t frames{0};
    std::uint64_t bytes{0};
    std::uint64_t lost_from{kNoFrame}; ///< First missing frame; kNoFrame: none.
};

/// Result of a trace, for the report.
struct TraceResult
{
    std::uint64_t frames{0};
    std::uint64_t rounds{0}; ///< Rounds of the chunk loader with requests or pieces.
    std::uint64_t bytes{0};
    std::uint64_t lost{0}; ///< Frames and rounds dropped because a queue was full.
};

/// Counts of the edits that this controller's tools asked for.
struct CutCounts
{
    std::uint64_t sent{0};
    std::uint64_t unsent{0}; ///< Cuts of models without edits, not permitted, or without room.
    std::uint64_t samples_lost{0}; ///< CutTap::lost().
    double volume_m3{0.0};         ///< Greatest volume that the sent ones remove.
};

} // namespace tactus::hrtc
