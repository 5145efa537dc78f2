// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/simulated_clock.hpp"
#include "platform/machine/periodic_timer.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <utility>

namespace tactus
{

/// The machine wakes the loop `lateness` too late at the sleep numbered `sleep`, counted from 0
/// over the timer's life (one a cycle while nothing stalls).
struct LateWake
{
    std::uint64_t sleep{0};
    Duration lateness;
};

/// Virtual time: each wait moves the clock to its end at once. Late wakes come from a script; a
/// frame's own time is added by the caller through SimulatedClock::advance().
class SimulatedPeriodicTimer final : public PeriodicTimer
{
public:
    /// `clock` and `script` are lent and must outlive the timer; `script` in order of `sleep`.
    explicit SimulatedPeriodicTimer(SimulatedClock& clock,
                                    std::span<const LateWake> script = {}) noexcept
        : clock_(clock), script_(script)
    {
    }

    /// What else happens while the loop sleeps: called in each sleep, at its end in virtual time,
    /// on the loop's thread. It must not throw and may take as long as it likes: no time passes.
    void set_meanwhile(std::function<void()> meanwhile) { meanwhile_ = std::move(meanwhile); }

private:
    [[nodiscard]] MonotonicTime now() noexcept override { return clock_.now(); }
    void sleep_until(MonotonicTime wake) noexcept override;
    [[nodiscard]] MonotonicTime spin_until(MonotonicTime deadline) noexcept override;

    SimulatedClock& clock_;
    std::span<const LateWake> script_;
    std::size_t script_at_{0};
    std::uint64_t sleeps_{0};
    std::function<void()> meanwhile_ = [] {};
};

} // namespace tactus
