// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/posix_periodic_timer.hpp"

#include "rt_core/base/assert.hpp"

#include <cerrno>
#include <ctime>

namespace tactus
{

namespace
{

std::int64_t read_clock_ns(clockid_t id) noexcept
{
    timespec time{};
    const int failed = clock_gettime(id, &time);
    TACTUS_ASSERT(failed == 0); // Both clocks exist on every supported system.
    return std::int64_t{time.tv_sec} * 1'000'000'000 + std::int64_t{time.tv_nsec};
}

} // namespace

// The kernel serves now() through the vDSO as a read of memory. If it makes a system call instead,
// the trap of platform/machine/system_call_trap.hpp counts the call.
TACTUS_TRUSTED_BEGIN
MonotonicTime PosixClock::now() const noexcept
{
    return {read_clock_ns(CLOCK_MONOTONIC)};
}
TACTUS_TRUSTED_END

WallTime PosixClock::wall_now() const noexcept
{
    return {read_clock_ns(CLOCK_REALTIME)};
}

MonotonicTime PosixPeriodicTimer::now() noexcept
{
    return clock_.now();
}

void PosixPeriodicTimer::sleep_until(MonotonicTime wake) noexcept
{
    timespec until{};
    until.tv_sec = static_cast<decltype(until.tv_sec)>(wake.ns / 1'000'000'000);
    until.tv_nsec = static_cast<decltype(until.tv_nsec)>(wake.ns % 1'000'000'000);
    int error = EINTR;
    while (error == EINTR)
    {
        error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
    TACTUS_ASSERT(error == 0); // All other errors mean a bad clock or time.
}

MonotonicTime PosixPeriodicTimer::spin_until(MonotonicTime deadline) noexcept
{
    MonotonicTime time = clock_.now();
    while (time < deadline)
    {
        time = clock_.now();
    }
    return time;
}

} // namespace tactus
