// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/simulated_periodic_timer.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"

#include <functional>
#include <utility>

namespace tactus::hrtc
{

/// Clock and timer of a run's loop: the machine's, or virtual ones. Virtual time stands still
/// during work, so nothing is late and a run is as fast as the machine allows.
class LoopTime
{
public:
    explicit LoopTime(bool is_virtual) noexcept : is_virtual_(is_virtual) {}
    LoopTime(const LoopTime&) = delete;
    LoopTime& operator=(const LoopTime&) = delete;

    [[nodiscard]] bool is_virtual() const noexcept { return is_virtual_; }
    /// Clock of the run. A virtual clock is for one thread only, the loop's while the loop runs.
    [[nodiscard]] const Clock& clock() const noexcept
    {
        return is_virtual_ ? static_cast<const Clock&>(virtual_clock_) : real_clock_;
    }
    [[nodiscard]] PeriodicTimer& timer() noexcept
    {
        return is_virtual_ ? static_cast<PeriodicTimer&>(virtual_timer_) : real_timer_;
    }
    /// Sets the work that the loop's thread does once a period in virtual time, besides the loop.
    void set_meanwhile(std::function<void()> meanwhile)
    {
        virtual_timer_.set_meanwhile(std::move(meanwhile));
    }

private:
    bool is_virtual_;
    PosixClock real_clock_;
    PosixPeriodicTimer real_timer_;
    /// Starts at 1 s: some callers use 0 for "never".
    SimulatedClock virtual_clock_{MonotonicTime{1'000'000'000}};
    SimulatedPeriodicTimer virtual_timer_{virtual_clock_};
};

} // namespace tactus::hrtc
