// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::hrtc
{

/// Times of one frame.
struct TracedFrame
{
    std::uint64_t frame{0};
    MonotonicTime deadline{}; ///< Deadline at which the frame was due.
    MonotonicTime start{};
    MonotonicTime end{};                   ///< Time when the force was written.
    std::array<Duration, kStages> stage{}; ///< Durations of the stages, consecutive from the start.
    Duration wake_lateness{};
    std::uint32_t periods{1};      ///< Whole periods since the last frame; above 1 after a stall.
    std::uint32_t arrivals{0};     ///< Arrivals taken from the queues.
    std::uint32_t link_updates{0}; ///< Link updates taken from the queues.
    std::uint32_t requests{0};     ///< Requests put into the queues.
    std::uint32_t splits{0};
    std::uint32_t merges{0};
    std::uint32_t triangles{0};
    FrameFault faults{FrameFault::none};
    bool in_contact{false};
};

// Bytes that the haptic thread copies a frame, as stated in docs/report.md.
static_assert(sizeof(TracedFrame) == 120);

/// Times and results of one round of the chunk loader.
struct TracedRound
{
    MonotonicTime start{};
    MonotonicTime end{};
    std::uint64_t requests{0};
    std::uint64_t pieces{0};
    std::uint64_t bytes{0};
    std::uint64_t delivered{0};
    std::uint64_t refused{0};
};

/// Passes times from the haptic and transport threads to the writing thread, in queues of fixed
/// size. No thread waits: entries that find a queue full are dropped and counted.
class TraceTap
{
public:
    /// Capacities in frames and rounds, each for at least a second.
    static constexpr std::size_t kFrames = 16'384;
    static constexpr std::size_t kRounds = 4'096;

    TraceTap()
        : frame_cells_(kFrames), frames_(frame_cells_), round_cells_(kRounds), rounds_(round_cells_)
    {
    }

    /// Haptic thread, after each frame. Allocates nothing.
    void add(const TracedFrame& frame) noexcept
    {
        if (!frames_.try_push(frame))
        {
            lost_.fetch_add(1, std::memory_order_relaxed); // A number for display; orders nothing.
        }
    }
    /// Transport thread, after each round with requests or pieces. Allocates nothing.
    void add(const TracedRound& round) noexcept
    {
        if (!rounds_.try_push(round))
        {
            lost_.fetch_add(1, std::memory_order_relaxed);
        }
    }

    /// Writing thread: moves the oldest entry into the argument; false if there is none.
    [[nodiscard]] bool try_take(TracedFrame& frame) noexcept { return frames_.try_pop(frame); }
    [[nodiscard]] bool try_take(TracedRound& round) noexcept { return rounds_.try_pop(round); }

    /// Any thread: number of dropped frames and rounds.
    [[nodiscard]] std::uint64_t lost() const noexcept
    {
        return lost_.load(std::memory_order_relaxed);
    }

private:
    std::vector<TracedFrame> frame_cells_;
    SpscQueue<TracedFrame> frames_;
    std::vector<TracedRound> round_cells_;
    SpscQueue<TracedRound> rounds_;
    std::atomic<std::uint64_t> lost_{0};
};

} // namespace tactus::hrtc
