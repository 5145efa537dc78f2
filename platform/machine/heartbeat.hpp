// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace tactus
{

/// The time of one thread's last cycle, for a watchdog. Wait-free, and allocates nothing.
class Heartbeat
{
public:
    /// Watched thread, once a cycle. `now`: time of the watchdog's clock.
    void beat(MonotonicTime now) noexcept
    {
        ns_.store(now.ns, std::memory_order_release); // Pairs with the acquire in last().
    }
    /// Watched thread: ends the beats.
    void rest() noexcept { ns_.store(kResting, std::memory_order_release); }

    /// Any thread: time of the last beat. None if no beat is due: before the first one and after
    /// rest().
    [[nodiscard]] std::optional<MonotonicTime> last() const noexcept
    {
        const std::int64_t ns = ns_.load(std::memory_order_acquire); // Pairs with the releases.
        return ns == kResting ? std::nullopt : std::optional(MonotonicTime{ns});
    }

private:
    static constexpr std::int64_t kResting = INT64_MIN;

    std::atomic<std::int64_t> ns_{kResting};
};

} // namespace tactus
