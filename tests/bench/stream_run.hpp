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

/// What streaming did for a tour.
struct StreamFigures
{
    std::uint64_t frames{0};
    std::uint64_t exact{0};
    std::uint64_t open{0};    ///< Frames whose answer was neither exact nor decided.
    std::uint64_t waiting{0}; ///< Frames in which the proxy waited for data.
    std::uint64_t taps{0};
    std::uint64_t late_taps{0}; ///< Their first frame in touch was open, or the proxy waited.
    std::uint64_t hits{0};      ///< Looks at wanted chunks that were here.
    std::uint64_t misses{0};    ///< Wishes.
    std::uint64_t loads{0};
    std::uint64_t reloads{0};       ///< Of chunks that were here before.
    std::uint64_t reload_bursts{0}; ///< Runs of reloads without half a second's rest in them.
    std::uint64_t bytes{0};         ///< Coded.
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

/// Counts what frames did, one after another.
class StreamCounter
{
public:
    explicit StreamCounter(const TapTour& tour) : tour_(tour) {}

    /// The output of a tour's next frame.
    void add(const FrameOutput& output);
    [[nodiscard]] const StreamFigures& figures() const { return figures_; }

private:
    void count_loads(std::span<const DoorEvent> events);

    const TapTour& tour_;
    StreamFigures figures_;
    std::set<std::uint32_t> seen_;
    std::uint64_t burst_ends_{0};
};

/// A tour over a model whose pieces come so many frames after they were asked for.
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
