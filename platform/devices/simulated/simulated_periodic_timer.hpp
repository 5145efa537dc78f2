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

/// A late wake-up by `lateness` at the sleep numbered `sleep`, counted from 0 over the timer's life
/// (one a cycle without stalls).
struct LateWake
{
    std::uint64_t sleep{0};
    Duration lateness;
};

/// Virtual time: each wait advances the clock to its end at once. Late wake-ups come from a script;
/// the caller adds a frame's own time through SimulatedClock::advance().
class SimulatedPeriodicTimer final : public PeriodicTimer
{
public:
    /// `clock` and `script` are borrowed and must outlive the timer; `script` in order of `sleep`.
    explicit SimulatedPeriodicTimer(SimulatedClock& clock,
                                    std::span<const LateWake> script = {}) noexcept
        : clock_(clock), script_(script)
    {
    }

    /// Sets work to do while the loop sleeps: called in each sleep, at its end in virtual time, on
    /// the loop's thread. It must not throw and takes no virtual time.
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
