// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/clock.hpp"
#include "rt_core/base/assert.hpp"

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

} // namespace tactus
