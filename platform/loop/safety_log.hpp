// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/records/safety.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::hrtc
{

/// A tool's state or causes became others.
struct SafetyEvent
{
    MonotonicTime time;
    std::uint64_t frame{0}; ///< Of the loop, from 0.
    std::uint32_t tool{0};
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none};
    bool by_supervisor{false}; ///< Noted by the supervisor, which has braked the device.
};

/// Carries events from one real-time thread to one that has time: a queue of fixed size. What finds
/// no room is counted and dropped.
class SafetyLog
{
public:
    /// Taken every 20 ms; even at 10 kHz and with a change in every frame four tools need fewer.
    /// 32 KiB.
    static constexpr std::size_t kEvents = 1'024;

    /// The thread whose events these are. Allocates nothing.
    void note(const SafetyEvent& event) noexcept
    {
        if (!queue_.try_push(event))
        {
            lost_.fetch_add(1, std::memory_order_relaxed); // A number to show; orders nothing.
        }
    }

    /// The other thread: moves what waits to the end of `events`.
    void take_into(std::vector<SafetyEvent>& events)
    {
        SafetyEvent event;
        while (queue_.try_pop(event))
        {
            events.push_back(event);
        }
    }

    /// Any thread.
    [[nodiscard]] std::uint64_t lost() const noexcept
    {
        return lost_.load(std::memory_order_relaxed);
    }

private:
    std::array<SafetyEvent, kEvents> slots_{};
    SpscQueue<SafetyEvent> queue_{slots_};
    std::atomic<std::uint64_t> lost_{0};
};

} // namespace tactus::hrtc
