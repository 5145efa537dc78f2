// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/base/spsc_queue.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Carries coded frames from the haptic thread to whoever writes them, through a queue of fixed
/// size. The haptic thread never waits: a frame that finds no room is lost, and with it all later
/// ones, since a replay can't go past a gap.
class FrameTap
{
public:
    /// Room for `cells` of 64 B; a frame of one tool and model takes 3 to 8, an object that
    /// its host moves 2 more, an arrival a third.
    explicit FrameTap(std::size_t cells = kUsualCells);

    /// A second or more of usual frames: 1 MiB.
    static constexpr std::size_t kUsualCells = 16'384;

    /// Haptic thread, after each run. Allocates nothing. At most kMaxSceneChanges changes;
    /// `devices` one a tool, or none.
    void record(const FrameInput& input, const FrameOutput& output,
                std::span<const DeviceRecord> devices = {}) noexcept;
    /// Likewise of a frame that failed, the last. Any thread once the haptic one records no more.
    void record_failed(const GivenFrame& frame) noexcept;

    /// The other thread, one: the next
    /// coded frame into `frame`, as FrameEncoder coded it; false when none waits. Allocates.
    [[nodiscard]] bool try_take(std::vector<std::byte>& frame);

    /// Any thread: the first frame that was lost, from 0, or kNoFrame.
    [[nodiscard]] std::uint64_t lost_from() const noexcept
    {
        return lost_from_.load(std::memory_order_relaxed); // A number to show; orders nothing.
    }

private:
    using Cell = std::array<std::byte, 64>;

    void put(std::span<const std::byte> coded) noexcept;

    FrameEncoder encoder_;
    std::vector<Cell> cells_;
    SpscQueue<Cell> queue_;
    std::uint64_t frames_{0};
    std::atomic<std::uint64_t> lost_from_{kNoFrame};
};

} // namespace tactus
