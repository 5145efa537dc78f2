// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <chrono>

namespace tactus::dds
{

/// Rate limit for an action that another program on the domain can trigger and that costs a little
/// each time: immediate at first, then after a second, then after twice the wait each time, up to a
/// minute.
class Backoff
{
public:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] bool is_due(Clock::time_point now) const noexcept { return now >= next_; }
    void begin(Clock::time_point now) noexcept
    {
        wait_ = std::clamp<Clock::duration>(2 * wait_, std::chrono::seconds(1),
                                            std::chrono::minutes(1));
        next_ = now + wait_;
    }

private:
    Clock::time_point next_{};
    Clock::duration wait_{};
};

} // namespace tactus::dds
