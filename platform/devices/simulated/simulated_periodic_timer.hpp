// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/clock.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "rt_core/base/assert.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <utility>

namespace tactus
{

/// Virtual time, which advances only on request, so a run repeats to the nanosecond and is as fast
/// as the machine allows. One thread.
class SimulatedClock final : public Clock
{
public:
    explicit SimulatedClock(MonotonicTime start = {}) noexcept : now_(start), start_(start) {}

    [[nodiscard]] MonotonicTime now() const noexcept TACTUS_NONBLOCKING override { return now_; }
    /// 2000-01-01 UTC plus the elapsed virtual time.
    [[nodiscard]] WallTime wall_now() const noexcept override
    {
        return {kStartOf2000Ns + (now_ - start_).ns};
    }

    /// Advances the time by `duration`, for instance the time of a frame's work; not negative.
    void advance(Duration duration) noexcept
    {
        TACTUS_ASSERT(duration >= Duration{});
        now_ = now_ + duration;
    }
    /// Advances the time to `time`; no effect if that has passed.
    void advance_to(MonotonicTime time) noexcept { now_ = time > now_ ? time : now_; }

private:
    static constexpr std::int64_t kStartOf2000Ns = 946'684'800'000'000'000;

    MonotonicTime now_;
    MonotonicTime start_;
};

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
    void sleep_until(MonotonicTime wake) noexcept override
    {
        clock_.advance_to(wake);
        if (script_at_ < script_.size() && script_[script_at_].sleep == sleeps_)
        {
            clock_.advance(script_[script_at_].lateness);
            ++script_at_;
        }
        ++sleeps_;
        meanwhile_();
    }
    [[nodiscard]] MonotonicTime spin_until(MonotonicTime deadline) noexcept override
    {
        clock_.advance_to(deadline);
        return clock_.now();
    }

    SimulatedClock& clock_;
    std::span<const LateWake> script_;
    std::size_t script_at_{0};
    std::uint64_t sleeps_{0};
    std::function<void()> meanwhile_ = [] {};
};

} // namespace tactus
