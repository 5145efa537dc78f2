// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/clock.hpp"
#include "rt_core/base/assert.hpp"

namespace tactus
{

/// Virtual time: it moves only when told to, so a run repeats to the nanosecond and is as fast as
/// the machine allows. One thread.
class SimulatedClock final : public Clock
{
public:
    explicit SimulatedClock(MonotonicTime start = {}) noexcept : now_(start), start_(start) {}

    [[nodiscard]] MonotonicTime now() const noexcept TACTUS_NONBLOCKING override { return now_; }
    /// 2000-01-01 UTC plus what has passed.
    [[nodiscard]] WallTime wall_now() const noexcept override
    {
        return {kStartOf2000Ns + (now_ - start_).ns};
    }

    /// Lets `duration` pass, for instance the time a frame's work takes; not negative.
    void advance(Duration duration) noexcept
    {
        TACTUS_ASSERT(duration >= Duration{});
        now_ = now_ + duration;
    }
    /// Lets the time pass up to `time`; no effect when that has passed.
    void advance_to(MonotonicTime time) noexcept { now_ = time > now_ ? time : now_; }

private:
    static constexpr std::int64_t kStartOf2000Ns = 946'684'800'000'000'000;

    MonotonicTime now_;
    MonotonicTime start_;
};

} // namespace tactus
