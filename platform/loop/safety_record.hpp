// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/safety_log.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::hrtc
{

/// The safety events of a run, for its report. Any one thread except the haptic one.
class SafetyRecord
{
public:
    explicit SafetyRecord(std::size_t tools) : last_causes_(tools) {}

    /// Number of events kept in full, enough for a report.
    static constexpr std::size_t kEventsKept = 1'000;

    void add(const SafetyEvent& event);
    /// Call after the last event: sorts the events by time. `lost` events were dropped before.
    void finish(std::uint64_t brakes, std::uint64_t lost);

    [[nodiscard]] const std::vector<SafetyEvent>& events() const noexcept { return events_; }
    /// Counts of the times that each cause began to hold for some tool, in the order of ForceOff's
    /// bits.
    [[nodiscard]] const std::array<std::uint64_t, kForceOffs>& begun() const noexcept
    {
        return begun_;
    }
    /// Number of silences that the supervisor ended with the brake.
    [[nodiscard]] std::uint64_t brakes() const noexcept { return brakes_; }
    /// Events that are not in events(): counted in begun(), or lost.
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    std::vector<SafetyEvent> events_;
    std::array<std::uint64_t, kForceOffs> begun_{};
    std::vector<ForceOff> last_causes_; ///< Causes, one a tool, as noted by its loop.
    std::uint64_t brakes_{0};
    std::uint64_t left_out_{0};
};

} // namespace tactus::hrtc
