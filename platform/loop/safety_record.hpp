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

/// The safety events of a run, for its report. Any one thread, not the haptic one.
class SafetyRecord
{
public:
    explicit SafetyRecord(std::size_t tools) : last_causes_(tools) {}

    /// Kept in full; a report that is read by people needs no more.
    static constexpr std::size_t kEventsKept = 1'000;

    void add(const SafetyEvent& event);
    /// After the last event: puts them in the order of time. `lost` events did not get here.
    void finish(std::uint64_t brakes, std::uint64_t lost);

    [[nodiscard]] const std::vector<SafetyEvent>& events() const noexcept { return events_; }
    /// How often each cause, in the order of ForceOff's bits, began to hold for some tool.
    [[nodiscard]] const std::array<std::uint64_t, kForceOffs>& begun() const noexcept
    {
        return begun_;
    }
    [[nodiscard]] std::uint64_t brakes() const noexcept { return brakes_; } ///< The supervisor's.
    /// Events that are counted in begun(), or not even that, but are not in events().
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    std::vector<SafetyEvent> events_;
    std::array<std::uint64_t, kForceOffs> begun_{};
    std::vector<ForceOff> last_causes_; ///< One a tool, as its loop noted them.
    std::uint64_t brakes_{0};
    std::uint64_t left_out_{0};
};

} // namespace tactus::hrtc
