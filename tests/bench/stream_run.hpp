// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/tap_tour.hpp"
#include "tests/shared/frame_rig.hpp"

#include <cstdint>
#include <set>
#include <span>

namespace tactus::bench
{

/// Result of streaming for a tour.
struct StreamFigures
{
    std::uint64_t frames{0};
    std::uint64_t exact{0};
    std::uint64_t open{0};    ///< Frames with neither an exact nor a separated answer.
    std::uint64_t waiting{0}; ///< Frames in which the proxy waited for data.
    std::uint64_t taps{0};
    /// Taps whose first frame in touch was open or had a waiting proxy.
    std::uint64_t late_taps{0};
    std::uint64_t hits{0};   ///< Lookups of wanted chunks that were resident.
    std::uint64_t misses{0}; ///< Requests.
    std::uint64_t loads{0};
    std::uint64_t reloads{0};       ///< Reloads of chunks that were resident before.
    std::uint64_t reload_bursts{0}; ///< Sequences of reloads without a pause of half a second.
    std::uint64_t bytes{0};         ///< Coded bytes.
    std::uint64_t hash{0};

    [[nodiscard]] double percent(std::uint64_t count) const
    {
        return 100.0 * static_cast<double>(count) / static_cast<double>(frames);
    }
    [[nodiscard]] double per_second(std::uint64_t count) const
    {
        return static_cast<double>(count) / (static_cast<double>(frames) * kPeriod_s);
    }
};

/// Counts the results of consecutive frames.
class StreamCounter
{
public:
    explicit StreamCounter(const TapTour& tour) : tour_(tour) {}

    /// Adds the output of a tour's next frame.
    void add(const FrameOutput& output);
    [[nodiscard]] const StreamFigures& figures() const { return figures_; }

private:
    void count_loads(std::span<const QueueEvent> events);

    const TapTour& tour_;
    StreamFigures figures_;
    std::set<std::uint32_t> seen_;
    std::uint64_t burst_ends_{0};
};

/// Tour over a model whose chunks arrive a fixed number of frames after their request.
struct StreamRun
{
    const Scene& scene;
    const TapTour& tour;
    std::uint32_t latency_frames{20};
    test::RigOptions rig;
    Budgets budgets;
};

[[nodiscard]] StreamFigures stream(const StreamRun& run);

} // namespace tactus::bench
