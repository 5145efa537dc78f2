// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/safety_record.hpp"

#include <algorithm>

namespace tactus::hrtc
{

void SafetyRecord::add(const SafetyEvent& event)
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

void SafetyRecord::finish(std::uint64_t brakes, std::uint64_t lost)
{
    brakes_ = brakes;
    left_out_ += lost;
    std::ranges::stable_sort(events_, {}, &SafetyEvent::time);
}

} // namespace tactus::hrtc
