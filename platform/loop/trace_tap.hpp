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

/// When a frame did what.
struct TracedFrame
{
    std::uint64_t frame{0};
    MonotonicTime deadline{}; ///< At which it was due.
    MonotonicTime start{};
    MonotonicTime end{};                   ///< The force is written.
    std::array<Duration, kStages> stage{}; ///< One after the other, from the start on.
    Duration wake_lateness{};
    std::uint32_t periods{1};      ///< Since the frame before.
    std::uint32_t arrivals{0};     ///< Taken from the door.
    std::uint32_t link_updates{0}; ///< Likewise.
    std::uint32_t wishes{0};       ///< Given to the door.
    std::uint32_t splits{0};
    std::uint32_t merges{0};
    std::uint32_t triangles{0};
    FrameFault faults{FrameFault::none};
    bool in_contact{false};
};

static_assert(sizeof(TracedFrame) == 120); // What the haptic thread copies: docs/report.md.

/// When a round of the courier did what, and what came of it.
struct TracedRound
{
    MonotonicTime start{};
    MonotonicTime end{};
    std::uint64_t wishes{0};
    std::uint64_t pieces{0};
    std::uint64_t bytes{0};
    std::uint64_t delivered{0};
    std::uint64_t refused{0};
};

/// Carries times from the threads that work to the one that writes them, through queues of fixed
/// size. Nobody waits: what finds no room is counted and left out.
class TraceTap
{
public:
    /// At least a second of either.
    static constexpr std::size_t kFrames = 16'384;
    static constexpr std::size_t kRounds = 4'096;

    TraceTap()
        : frame_cells_(kFrames), frames_(frame_cells_), round_cells_(kRounds), rounds_(round_cells_)
    {
    }

    /// The haptic thread, after each frame. Allocates nothing.
    void add(const TracedFrame& frame) noexcept
    {
        if (!frames_.try_push(frame))
        {
            lost_.fetch_add(1, std::memory_order_relaxed); // A number to show; orders nothing.
        }
    }
    /// The transport thread, after each round that did something.
    void add(const TracedRound& round) noexcept
    {
        if (!rounds_.try_push(round))
        {
            lost_.fetch_add(1, std::memory_order_relaxed);
        }
    }

    /// One other thread: the next, if one waits.
    [[nodiscard]] bool try_take(TracedFrame& frame) noexcept { return frames_.try_pop(frame); }
    [[nodiscard]] bool try_take(TracedRound& round) noexcept { return rounds_.try_pop(round); }

    /// Any thread: how many found no room.
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
