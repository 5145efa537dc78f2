// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace tactus
{

class Frame;
struct Kernels;

/// First difference between a replay and its recording.
struct ReplayDifference
{
    std::uint64_t frame{0}; ///< Number of the frame, from 0.
    std::string text;       ///< Difference, in words that follow "frame N differs: ".
};

/// Result of a replay.
struct ReplayReport
{
    std::uint64_t frames{0}; ///< Number of replayed frames, including the one that differs.
    std::optional<ReplayDifference> difference;
};

/// Callbacks of a replay, on the replaying thread; any may be empty. `begins` and `ends` get the
/// frame's number, from 0, right before and right after the frame runs. Its queues and pages are
/// ready by then.
struct ReplayWatch
{
    using Ends = void(std::uint64_t, const RecordedFrame& given, const FrameOutput& returned);

    std::function<void(std::uint64_t)> begins{};
    std::function<Ends> ends{}; ///< `given` and `returned` are valid during the call.
    /// Called once, before all others, with the Frame that will run. The Frame is valid until the
    /// replay ends, and must not be changed.
    std::function<void(Frame&)> made{};
    /// Called after each frame: false ends the replay there.
    std::function<bool()> goes_on{};
    /// False: the replay ends before a frame that failed in the run.
    bool runs_failed{true};
};

/// Replays a recording: makes its frame, feeds it the recorded inputs, arrivals and link updates,
/// and compares the results with the recorded hashes. Stops at the first difference. Needs no
/// device, network, timer or thread; takes the pools' memory, and the time of the frames. Refused
/// if no frame can be made of the setup, or the recording doesn't keep a run. A frame that failed
/// in the run fails its assertion here, too; if it doesn't fail, that is the difference.
///
/// The same Linker links pages again in the recorded order, and their links are compared, too.
/// `kernels` run the queries; null: the best ones of this processor. Results are the same for all
/// kernels.
[[nodiscard]] Result<ReplayReport, Refusal>
replay(const Recording& recording, const Kernels* kernels = nullptr, const ReplayWatch& watch = {});

/// Outcome in one line, without a line end: the number of equal frames, or the first that differs;
/// the recording program; and missing frames.
[[nodiscard]] std::string replay_line(const Recording& recording, const ReplayReport& report);

} // namespace tactus
