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

/// Passes coded frames from the haptic thread to the writing thread, in a queue of fixed size. The
/// haptic thread never waits: a frame that doesn't fit is lost, and so are all later ones, since a
/// replay can't skip a gap.
class FrameTap
{
public:
    /// `cells`: capacity in cells of 64 bytes. A frame of one tool and one model takes 3 to 8
    /// cells. Each object that its server moves takes 2 more, each arrival a third of one.
    explicit FrameTap(std::size_t cells = kUsualCells);

    /// Capacity for a second or more of usual frames: 1 MiB.
    static constexpr std::size_t kUsualCells = 16'384;

    /// Haptic thread, after each run: records a frame with up to kMaxSceneChanges changes.
    /// Allocates nothing. `devices`: one record a tool, or empty.
    void record(const FrameInput& input, const FrameOutput& output,
                std::span<const DeviceRecord> devices = {}) noexcept;
    /// Records the input of a frame that failed, as the last one. Any thread, once the haptic
    /// thread records no more. Allocates nothing.
    void record_failed(const GivenFrame& frame) noexcept;

    /// Writing thread: takes the next frame, as FrameEncoder coded it; false if there is none.
    /// Allocates.
    [[nodiscard]] bool try_take(std::vector<std::byte>& frame);

    /// Any thread: the first frame that was lost, from 0, or kNoFrame.
    [[nodiscard]] std::uint64_t lost_from() const noexcept
    {
        return lost_from_.load(std::memory_order_relaxed); // A number for display; orders nothing.
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
