// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <compare>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A span of time in whole nanoseconds; 64 bits last 292 years, so sums never overflow in practice.
struct Duration
{
    std::int64_t ns{0};

    constexpr auto operator<=>(const Duration&) const noexcept = default;
    constexpr Duration& operator+=(Duration other) noexcept
    {
        ns += other.ns;
        return *this;
    }
};

[[nodiscard]] constexpr Duration nanoseconds(std::int64_t count) noexcept
{
    return {count};
}
[[nodiscard]] constexpr Duration microseconds(std::int64_t count) noexcept
{
    return {count * 1'000};
}
[[nodiscard]] constexpr Duration milliseconds(std::int64_t count) noexcept
{
    return {count * 1'000'000};
}

[[nodiscard]] constexpr Duration operator+(Duration a, Duration b) noexcept
{
    return {a.ns + b.ns};
}
[[nodiscard]] constexpr Duration operator-(Duration a, Duration b) noexcept
{
    return {a.ns - b.ns};
}
[[nodiscard]] constexpr Duration operator*(Duration a, std::int64_t factor) noexcept
{
    return {a.ns * factor};
}
/// Number of whole `b` in `a`; `b` must not be zero.
[[nodiscard]] constexpr std::int64_t operator/(Duration a, Duration b) noexcept
{
    return a.ns / b.ns;
}
[[nodiscard]] constexpr double to_seconds(Duration duration) noexcept
{
    return static_cast<double>(duration.ns) * 1e-9;
}
[[nodiscard]] constexpr double to_us(Duration duration) noexcept
{
    return static_cast<double>(duration.ns) * 1e-3;
}

/// A point on a clock that never jumps, in nanoseconds from an arbitrary start, for deadlines and
/// latencies. Points are meaningless on another machine or after a reboot.
struct MonotonicTime
{
    std::int64_t ns{0};

    constexpr auto operator<=>(const MonotonicTime&) const noexcept = default;
};

[[nodiscard]] constexpr Duration operator-(MonotonicTime a, MonotonicTime b) noexcept
{
    return {a.ns - b.ns};
}
[[nodiscard]] constexpr MonotonicTime operator+(MonotonicTime time, Duration duration) noexcept
{
    return {time.ns + duration.ns};
}
[[nodiscard]] constexpr MonotonicTime operator-(MonotonicTime time, Duration duration) noexcept
{
    return {time.ns - duration.ns};
}

/// Nanoseconds since 1970-01-01 UTC, for the readers of reports. The system may set it back at any
/// moment, so it has no arithmetic and no deadline may use it.
struct WallTime
{
    std::int64_t ns{0};

    constexpr auto operator<=>(const WallTime&) const noexcept = default;
};

} // namespace tactus
