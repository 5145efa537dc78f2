// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/posix_periodic_timer.hpp"

#include <cerrno>
#include <ctime>

namespace tactus
{

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
