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

/// Change of a tool's safety state, or of the causes of its fade.
struct SafetyEvent
{
    MonotonicTime time;
    std::uint64_t frame{0}; ///< Number of the loop's frame, from 0.
    std::uint32_t tool{0};
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none};
    bool by_supervisor{false}; ///< True for a brake by the supervisor; `frame` is then 0.
};

/// Passes events from one real-time thread to one other thread in a queue of fixed size. Events
/// that find the queue full are dropped and counted.
class SafetyLog
{
public:
    /// Capacity of the queue, 32 KiB. Events are taken every 20 ms; even at 10 kHz and with a
    /// change in every frame four tools need less.
    static constexpr std::size_t kEvents = 1'024;

    /// Real-time thread: queues the event. Allocates nothing.
    void note(const SafetyEvent& event) noexcept
    {
        if (!queue_.try_push(event))
        {
            lost_.fetch_add(1, std::memory_order_relaxed); // A number for display; orders nothing.
        }
    }

    /// Other thread: moves the waiting events to the end of `events`.
    void take_into(std::vector<SafetyEvent>& events)
    {
        SafetyEvent event;
        while (queue_.try_pop(event))
        {
            events.push_back(event);
        }
    }

    /// Any thread: number of dropped events.
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
