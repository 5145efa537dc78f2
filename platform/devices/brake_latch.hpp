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

/// The brake of a device with its own clock: at once, or by a fade over kBrakeFade.
///
///     share of the last force
///     1 -----.                        .---   the next write after the release
///             '.                      :
///               '.                    :
///     0           '-------------------'
///          brake_softly()   |      release
///                        or brake() here
///
/// Its state is one word, so that no thread sees parts of two brakes. It is sequentially
/// consistent: it is rare and orders nothing else.
class BrakeLatch
{
public:
    /// Any thread: brakes at once. If a fade had begun, the brake counts from the fade's start; if
    /// it was released meanwhile, the brake has no start.
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
    /// Any thread: true if it was on at that time.
    [[nodiscard]] bool is_on_at(MonotonicTime time) const noexcept
    {
        return time >= began(word_.load());
    }
    /// Any thread: the earlier of that time and the start of the brake.
    [[nodiscard]] MonotonicTime before(MonotonicTime time) const noexcept
    {
        return std::min(time, began(word_.load()));
    }
    /// Any thread: fraction of the last force at that time, 0 to 1.
    [[nodiscard]] double share_at(MonotonicTime time) const noexcept
    {
        return share_at(time, word_.load());
    }

    /// Haptic thread: true if a fade is not over. Then the next write ends it.
    [[nodiscard]] bool try_yield(MonotonicTime now) noexcept
    {
        const std::uint64_t word = word_.load();
        is_yielding_ = is_on(word) && share_at(now, word) > 0.0;
        return is_yielding_;
    }
    /// Haptic thread.
    void release() noexcept { word_.store(kOff); }

    /// Haptic thread, in a write: true if the write takes effect.
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
        // It fails if brake() was called since.
        return word_.compare_exchange_strong(word, kOff);
    }

private:
    /// The word has the brake's start in ns, above two bits. Without the upper bit the brake is on,
    /// without both it is on at once: so one operation turns any state into that.
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

    /// Returns false if it was on.
    bool begin(std::uint64_t on) noexcept
    {
        std::uint64_t off = kOff;
        return word_.compare_exchange_strong(off, on);
    }

    std::atomic<std::uint64_t> word_{kOff};
    bool is_yielding_{false}; ///< Used by the haptic thread only.
};

} // namespace tactus
