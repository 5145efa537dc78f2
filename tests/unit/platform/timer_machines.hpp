// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/simulated_periodic_timer.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"

#include <chrono>
#include <thread>

/// Backends of the clock and the timer, with a way to let time pass.
namespace tactus::test
{

struct Machine
{
    virtual ~Machine() = default;
    [[nodiscard]] virtual PeriodicTimer& timer() = 0;
    [[nodiscard]] virtual const Clock& clock() = 0;
    /// Lets at least this time pass: a frame's work, or a stall.
    virtual void pass(Duration duration) = 0;
};

struct PosixMachine final : Machine
{
    PeriodicTimer& timer() override { return timer_; }
    const Clock& clock() override { return clock_; }
    void pass(Duration duration) override
    {
        std::this_thread::sleep_for(std::chrono::nanoseconds(duration.ns));
    }

private:
    PosixClock clock_;
    PosixPeriodicTimer timer_;
};

struct SimulatedMachine final : Machine
{
    PeriodicTimer& timer() override { return timer_; }
    const Clock& clock() override { return clock_; }
    void pass(Duration duration) override { clock_.advance(duration); }

private:
    SimulatedClock clock_{MonotonicTime{12'345}};
    SimulatedPeriodicTimer timer_{clock_};
};

} // namespace tactus::test
