// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/safety_log.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::hrtc
{

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
