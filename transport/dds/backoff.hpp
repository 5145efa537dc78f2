// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <chrono>

namespace tactus::dds
{

/// Rate limit for an action with a cost that other programs on the domain can trigger. The first
/// action is immediate, the next one a second later; each further wait doubles, up to a minute.
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
