// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "platform/machine/time.hpp"

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
/// All of it is one word, so that nobody sees a half of one brake and a half of the next. It is
/// sequentially consistent: it is rare and orders nothing else.
class BrakeLatch
{
public:
    /// Any thread. Where a fade had begun, it is one that began then; where it was released
    /// meanwhile, one without a beginning.
    void brake(MonotonicTime now) noexcept
    {
        if (!begin(at_once(now)))
        {
            word_.fetch_and(~kOff);
        }
    }
    /// Any thread.
    void brake_softly(MonotonicTime now) noexcept { begin(at_once(now) | kFades); }

    /// Any thread.
    [[nodiscard]] bool is_on() const noexcept { return is_on(word_.load()); }
    /// Any thread: whether it was on at that time.
    [[nodiscard]] bool is_on_at(MonotonicTime time) const noexcept
    {
        return time >= began(word_.load());
    }
    /// Any thread: that time, or when the brake came, whichever is earlier.
    [[nodiscard]] MonotonicTime before(MonotonicTime time) const noexcept
    {
        return std::min(time, began(word_.load()));
    }
    /// Any thread: what is left of the last force at that time, 0 to 1.
    [[nodiscard]] double share_at(MonotonicTime time) const noexcept
    {
        return share_at(time, word_.load());
    }

    /// The haptic thread: whether it is a fade that isn't over. Then the next write ends it.
    [[nodiscard]] bool try_yield(MonotonicTime now) noexcept
    {
        const std::uint64_t word = word_.load();
        is_yielding_ = is_on(word) && share_at(now, word) > 0.0;
        return is_yielding_;
    }
    /// The haptic thread.
    void release() noexcept { word_.store(kOff); }

    /// The haptic thread, in a write: whether it counts.
    [[nodiscard]] bool lets_through() noexcept
    {
        std::uint64_t word = word_.load();
        if (!is_on(word))
        {
            return true;
        }
        if (!is_yielding_ || !fades(word))
        {
            return false;
        }
        is_yielding_ = false;
        return word_.compare_exchange_strong(word, kOff); // Unless a brake at once has come since.
    }

private:
    /// When it began, in ns, over two bits. Without the upper bit the brake is on, without both at
    /// once: so one operation turns whatever is there into that.
    static constexpr std::uint64_t kFades = 1;
    static constexpr std::uint64_t kOff = 3;

    static std::uint64_t at_once(MonotonicTime now) noexcept
    {
        return static_cast<std::uint64_t>(now.ns) << 2;
    }
    static bool is_on(std::uint64_t word) noexcept { return (word & kOff) != kOff; }
    static bool fades(std::uint64_t word) noexcept { return (word & kOff) == kFades; }
    static MonotonicTime began(std::uint64_t word) noexcept
    {
        constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
        return {is_on(word) ? static_cast<std::int64_t>(word >> 2) : kNever};
    }
    static double share_at(MonotonicTime time, std::uint64_t word) noexcept
    {
        if (time < began(word))
        {
            return 1.0;
        }
        const Duration gone = time - began(word);
        const double left = 1.0 - static_cast<double>(gone.ns) / static_cast<double>(kBrakeFade.ns);
        return fades(word) && gone < kBrakeFade ? left : 0.0;
    }

    /// False when it was on.
    bool begin(std::uint64_t on) noexcept
    {
        std::uint64_t off = kOff;
        return word_.compare_exchange_strong(off, on);
    }

    std::atomic<std::uint64_t> word_{kOff};
    bool is_yielding_{false}; ///< The haptic thread's.
};

} // namespace tactus
