// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/records/safety.hpp"

#include <algorithm>
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

/// Safety events of a run, for its report. One thread at a time, not within a frame.
class SafetyRecord
{
public:
    explicit SafetyRecord(std::size_t tools) : last_causes_(tools) {}

    /// Largest number of events kept in full; later ones are only counted.
    static constexpr std::size_t kEventsKept = 1'000;

    void add(const SafetyEvent& event)
    {
        // The supervisor's events are not counted: the loop notes their causes once it runs again.
        if (!event.by_supervisor)
        {
            ForceOff& last = last_causes_[event.tool];
            const std::uint32_t began =
                static_cast<std::uint32_t>(event.causes) & ~static_cast<std::uint32_t>(last);
            for (std::size_t bit = 0; bit < begun_.size(); ++bit)
            {
                begun_[bit] += (began >> bit) & 1U;
            }
            last = event.causes;
        }
        if (events_.size() < kEventsKept)
        {
            events_.push_back(event);
            return;
        }
        ++left_out_;
    }
    /// Sorts the events by time; call it after the last add(). `brakes`: brakes of the supervisor.
    /// `lost`: events dropped by the logs.
    void finish(std::uint64_t brakes, std::uint64_t lost)
    {
        brakes_ = brakes;
        left_out_ += lost;
        std::ranges::stable_sort(events_, {}, &SafetyEvent::time);
    }

    [[nodiscard]] const std::vector<SafetyEvent>& events() const noexcept { return events_; }
    /// Number of times that each cause began for a tool, in the order of ForceOff's bits.
    [[nodiscard]] const std::array<std::uint64_t, kForceOffs>& begun() const noexcept
    {
        return begun_;
    }
    /// Number of silences of the loop for which the supervisor braked the devices.
    [[nodiscard]] std::uint64_t brakes() const noexcept { return brakes_; }
    /// Number of events missing in events(): those beyond kEventsKept, and those dropped by the
    /// logs.
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    std::vector<SafetyEvent> events_;
    std::array<std::uint64_t, kForceOffs> begun_{};
    std::vector<ForceOff> last_causes_; ///< Causes of each tool in the loop's last event.
    std::uint64_t brakes_{0};
    std::uint64_t left_out_{0};
};

} // namespace tactus::hrtc
