// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace tactus
{

/// The sign of life of one thread, for whoever watches it: when it last came round. Wait-free, and
/// allocates nothing.
class Heartbeat
{
public:
    /// The watched thread, once a cycle. `now` from the clock that the watcher reads, too.
    void beat(MonotonicTime now) noexcept
    {
        ns_.store(now.ns, std::memory_order_release); // Pairs with the acquire in last().
    }
    /// The watched thread: no more beats are to be expected.
    void rest() noexcept { ns_.store(kResting, std::memory_order_release); }

    /// Any thread. None while nothing is to be expected: before the first beat and after rest().
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
