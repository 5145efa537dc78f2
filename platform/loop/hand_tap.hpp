// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/hand_state.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/tool_force.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// Counts since the start of the loop.
struct LoopCounts
{
    std::uint64_t frames{0};
    std::uint64_t missed{0};
    std::uint64_t overruns{0};
    std::uint64_t latency_misses{0};
};

/// Data of one frame for the program's own view of its hands; one entry a tool in each span.
struct HandFrame
{
    std::uint64_t frame{0}; ///< Number of this frame, from 0.
    std::span<const ToolState> tools;
    std::span<const DeviceRecord> devices;
    std::span<const ToolForce> forces;
    std::span<const double> radii_m;
    const FrameOutput& output;
    LoopCounts counts;
};

/// Passes every frame's hand states through mailboxes, one a tool; the haptic thread never waits
/// for readers.
class HandTap
{
public:
    explicit HandTap(std::size_t tools);

    /// Haptic thread, after the forces are written. Allocates nothing; some 500 instructions a
    /// tool.
    void show(const HandFrame& frame) noexcept;

    /// Any thread: state of the tool after the newest frame; default values before the first one.
    [[nodiscard]] HandState state(std::size_t tool) const noexcept;

    /// Thread of the loop, between frames: state of the tool, without a mailbox.
    [[nodiscard]] const HandState& last(std::size_t tool) const noexcept { return last_[tool]; }

    /// Any thread: counts after the newest frame.
    [[nodiscard]] LoopCounts counts() const noexcept;

    /// Any thread: number of the supervisor's brakes, as noted last.
    [[nodiscard]] std::uint64_t brakes() const noexcept
    {
        return brakes_.load(std::memory_order_relaxed);
    }
    void note_brakes(std::uint64_t brakes) noexcept
    {
        brakes_.store(brakes, std::memory_order_relaxed);
    }
    /// Any thread: notes that the tool began inside a closed object; later states have it.
    void note_begins_inside(std::size_t tool) noexcept;

private:
    std::vector<HandState> last_; ///< Newest states; thread of the loop only.
    // They don't move. NOLINTNEXTLINE(*-avoid-c-arrays)
    std::unique_ptr<Mailbox<HandState>[]> mailboxes_;
    Mailbox<LoopCounts> counts_;
    std::atomic<std::uint64_t> brakes_{0}; ///< Relaxed: for display only.
    std::atomic<bool> has_frame_{false};   ///< Relaxed: a reader that sees it too late is harmless.
    std::atomic<std::uint32_t> begins_inside_{0}; ///< Bit n: tool n. Relaxed: it orders nothing.
};

} // namespace tactus::hrtc
