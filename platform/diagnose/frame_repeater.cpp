// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/self_check.hpp"
#include "platform/machine/thread_usage.hpp"
#include "platform/recording/replay.hpp"

#include <fmt/format.h>

#include <set>

namespace tactus::hrtc
{

Result<std::vector<std::uint64_t>, std::string>
frames_over_again(const Recording& recording, std::span<const std::uint64_t> suspects,
                  Duration limit)
{
    std::set<std::uint64_t> over(suspects.begin(), suspects.end());
    Duration before;
    const ReplayWatch watch{
        [&before](std::uint64_t) { before = read_thread_cpu_time(); },
        [&](std::uint64_t frame, const RecordedFrame& /*unused*/, const FrameOutput& /*unused*/)
        {
            if (read_thread_cpu_time() - before <= limit)
            {
                over.erase(frame);
            }
        }};
    for (int i = 0; i < kRepetitions && !over.empty(); ++i)
    {
        const auto replayed = replay(recording, nullptr, watch);
        if (!replayed)
        {
            return replayed.error().text;
        }
        if (replayed.value().difference)
        {
            return replay_line(recording, replayed.value());
        }
        if (suspects.back() >= replayed.value().frames)
        {
            return fmt::format("frame {} is not in the recording of {} frames", suspects.back(),
                               replayed.value().frames);
        }
    }
    return std::vector<std::uint64_t>(over.begin(), over.end());
}

} // namespace tactus::hrtc
