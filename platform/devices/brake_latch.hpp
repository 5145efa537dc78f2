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

/// Brake of a device: ends the force at once, or fades it over kBrakeFade. All times are those of
/// the device's clock.
///
///     share of the last force
///     1 -----.                        .---   the next write after the release
///             '.                      :
///               '.                    :
///     0           '-------------------'
///          brake_softly()   |      release
///                        or brake() here
///
/// The state is one atomic word, so that no thread sees parts of two brakes. All accesses are
/// sequentially consistent; no other data depends on their order.
class BrakeLatch
{
public:
    /// Any thread: ends the force at once. A fade under way keeps its start. If another thread
    /// releases the fade during this call, the start becomes time 0.
    void brake(MonotonicTime now) noexcept
    {
        if (!begin(at_once(now)))
        {
            word_.fetch_and(~kOff);
        }
    }
    /// Any thread: starts a fade at `now`; no effect if the brake is on.
    void brake_softly(MonotonicTime now) noexcept { begin(at_once(now) | kFades); }

    /// Any thread: true from a brake until its release.
    [[nodiscard]] bool is_on() const noexcept { return is_on(word_.load()); }
    /// Any thread: true if the brake is on and began at or before `time`.
    [[nodiscard]] bool is_on_at(MonotonicTime time) const noexcept
    {
        return time >= began(word_.load());
    }
    /// Any thread: the earlier of `time` and the brake's start; `time` if the brake is off.
    [[nodiscard]] MonotonicTime before(MonotonicTime time) const noexcept
    {
        return std::min(time, began(word_.load()));
    }
    /// Any thread: fraction of the last written force that is left at `time`. 1 before a brake, 0
    /// after a fade or during a brake at once.
    [[nodiscard]] double share_at(MonotonicTime time) const noexcept
    {
        return share_at(time, word_.load());
    }

    /// Haptic thread: true if a fade still leaves some force. Then the next write releases the
    /// brake.
    [[nodiscard]] bool try_yield(MonotonicTime now) noexcept
    {
        const std::uint64_t word = word_.load();
        is_yielding_ = is_on(word) && share_at(now, word) > 0.0;
        return is_yielding_;
    }
    /// Haptic thread: releases the brake, even during a fade.
    void release() noexcept { word_.store(kOff); }

    /// Haptic thread, once in each write: true if the write takes effect. Releases a fading brake
    /// if try_yield() returned true before.
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
        // The exchange fails if another thread called brake() after the load.
        return word_.compare_exchange_strong(word, kOff);
    }

private:
    /// The word holds the brake's start in ns above two low bits. These are 0 for a brake at once,
    /// 1 for a fade and 3 for no brake. Clearing both bits turns any state into a brake at once.
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

    /// Sets the word to `on` if the brake is off; otherwise returns false without effect.
    bool begin(std::uint64_t on) noexcept
    {
        std::uint64_t off = kOff;
        return word_.compare_exchange_strong(off, on);
    }

    std::atomic<std::uint64_t> word_{kOff};
    bool is_yielding_{false}; ///< True if the next write may end the fade; haptic thread.
};

} // namespace tactus
