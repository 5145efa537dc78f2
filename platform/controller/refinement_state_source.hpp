// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/refinement_state_tap.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/limits.hpp"
#include "transport/dds/telemetry.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace tactus::hrtc
{

class Controller;

/// Refinement state for viewers: the haptic thread's copy, completed by data of the transport
/// thread such as model hashes, tool shapes and requested chunks. Means cover the frames since
/// `before`, the times of the last copy. Transport thread; allocates.
[[nodiscard]] RefinementState refinement_state_of(const RefinementStateCopy& copy,
                                                  const RefinementStateCopy::AllTimes& before,
                                                  const Controller& controller);

/// Makes the controller's refinement states from the haptic thread's copies, on the transport
/// thread.
class RefinementStateSource
{
public:
    /// Shortest time between two refinement states.
    static constexpr Duration kPeriod = milliseconds(100);

    /// `controller` must outlive the source.
    explicit RefinementStateSource(const Controller& controller) : controller_(controller) {}

    /// Connects the haptic thread's tap. Call it before the first take(). The tap must outlive the
    /// last take().
    void connect(RefinementStateTap& tap) noexcept { tap_ = &tap; }

    /// A refinement state if kPeriod has passed since the last one, a viewer wants it and a copy is
    /// there. While no viewer wants states, the copy isn't given back, so the haptic thread makes
    /// no other.
    [[nodiscard]] std::optional<RefinementState> take(MonotonicTime now,
                                                      const dds::TelemetryWriter& writer);

    /// Sets the flag of the tool that it began inside a closed object. Any thread.
    void tell_begins_inside(std::size_t tool) noexcept
    {
        begin_inside_.fetch_or(1U << tool, std::memory_order_relaxed); // Orders no other data.
    }

private:
    const Controller& controller_;
    RefinementStateTap* tap_{nullptr};
    static_assert(kMaxTools <= 32);
    /// One bit a tool: set if the tool began inside a closed object.
    std::atomic<std::uint32_t> begin_inside_{0};
    RefinementStateCopy::AllTimes last_times_{};
    MonotonicTime last_{}; ///< Time of the last copy that was looked at.
    /// True if the present copy may be from before a viewer watched; such a copy is not sent.
    bool is_old_{true};
};

} // namespace tactus::hrtc
