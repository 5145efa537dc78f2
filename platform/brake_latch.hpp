// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/haptic_device.hpp"
#include "platform/time.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>

namespace tactus
{

/// The brake of a device that has a time of its own: at once, or by a fade over kBrakeFade.
///
///     share of the last force
///     1 -----.                        .---   the next write after the release
///             '.                      :
///               '.                    :
///     0           '-------------------'
///          brake_softly()   |      release
///                        or brake() here
///
/// Atomics are sequentially consistent: they are rare and order nothing else.
class BrakeLatch
{
public:
    /// Any thread.
    void brake(MonotonicTime now) noexcept
    {
        is_at_once_.store(true);
        begin(now);
    }
    /// Any thread.
    void brake_softly(MonotonicTime now) noexcept { begin(now); }

    /// Any thread.
    [[nodiscard]] bool is_on() const noexcept { return began_ns_.load() != kNever; }
    /// Any thread: whether it was on at that time.
    [[nodiscard]] bool is_on_at(MonotonicTime time) const noexcept
    {
        return time.ns >= began_ns_.load();
    }
    /// Any thread: that time, or when the brake came, whichever is earlier.
    [[nodiscard]] MonotonicTime before(MonotonicTime time) const noexcept
    {
        return {std::min(time.ns, began_ns_.load())};
    }
    /// Any thread: what is left of the last force at that time, 0 to 1.
    [[nodiscard]] double share_at(MonotonicTime time) const noexcept
    {
        const std::int64_t began_ns = began_ns_.load();
        if (time.ns < began_ns)
        {
            return 1.0;
        }
        const std::int64_t gone_ns = time.ns - began_ns;
        const double left = 1.0 - static_cast<double>(gone_ns) / static_cast<double>(kBrakeFade.ns);
        return is_at_once_.load() || gone_ns >= kBrakeFade.ns ? 0.0 : left;
    }

    /// The haptic thread: whether it is a fade that isn't over. Then the next write ends it.
    [[nodiscard]] bool try_yield(MonotonicTime now) noexcept
    {
        is_yielding_ = is_on() && share_at(now) > 0.0;
        return is_yielding_;
    }
    /// The haptic thread.
    void release() noexcept
    {
        began_ns_.store(kNever);
        is_at_once_.store(false);
    }

    /// The haptic thread, in a write: whether it counts.
    [[nodiscard]] bool lets_through() noexcept
    {
        if (!is_on())
        {
            return true;
        }
        if (!is_yielding_ || is_at_once_.load())
        {
            return false;
        }
        is_yielding_ = false;
        const std::int64_t began_ns = began_ns_.exchange(kNever);
        if (is_at_once_.load()) // A brake that has come since found it on.
        {
            begin({began_ns});
            return false;
        }
        return true;
    }

private:
    static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

    void begin(MonotonicTime now) noexcept
    {
        std::int64_t never = kNever;
        began_ns_.compare_exchange_strong(never, now.ns);
    }

    std::atomic<std::int64_t> began_ns_{kNever}; ///< kNever: it is off.
    std::atomic<bool> is_at_once_{false};
    bool is_yielding_{false}; ///< The haptic thread's.
};

} // namespace tactus
