// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace tactus
{

/// Where a replay first went another way than the recording.
struct ReplayDifference
{
    std::uint64_t frame{0}; ///< From 0.
    std::string text;       ///< What differs, in words that follow "frame N: ".
};

struct ReplayReport
{
    std::uint64_t frames{0}; ///< Replayed, the one that differs included.
    std::optional<ReplayDifference> difference;
};

/// Called with a frame's number, from 0, right before and right after it runs, on the thread that
/// replays; the door is open and pages are linked by then. Any may be empty.
struct ReplayWatch
{
    using Ends = void(std::uint64_t, const RecordedFrame& given, const FrameOutput& returned);

    std::function<void(std::uint64_t)> begins{};
    std::function<Ends> ends{}; ///< Both are valid during the call.
    /// Once, before all: the frame that will run, there until the replay ends. Only to be read.
    std::function<void(Frame&)> made{};
    /// Asked after each frame: false ends the replay there.
    std::function<bool()> goes_on{};
    /// False: the replay ends before a frame that failed in the run.
    bool runs_failed{true};
};

/// Makes a frame as the recorded one was made, gives it the recorded inputs, arrivals and link
/// updates of every frame, and compares what comes out with the recorded hashes. Stops at the first
/// difference. Needs no device, network, timer or thread; takes the pools' memory, and the time of
/// the frames. Refused when no frame can be made of the set-up, or the recording doesn't keep a
/// run. A frame that failed in the run fails its assertion here, too; where it doesn't, that is the
/// difference.
///
/// Pages are linked here anew, by the same Linker in the recorded order, and compared, too.
/// `kernels` run the queries, null the best of this processor; it makes no difference.
[[nodiscard]] Result<ReplayReport, Refusal>
replay(const Recording& recording, const Kernels* kernels = nullptr, const ReplayWatch& watch = {});

/// The outcome in one line without an end: how many frames agree, or the first that differs; what
/// recorded them; and whether some are missing.
[[nodiscard]] std::string replay_line(const Recording& recording, const ReplayReport& report);

} // namespace tactus
