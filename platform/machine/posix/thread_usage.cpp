// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/thread_usage.hpp"

#include "platform/machine/posix/linux_extras.hpp"
#include "rt_core/base/assert.hpp"

#include <csignal>
#include <ctime>

namespace tactus
{

ThreadUsage read_thread_usage() noexcept
{
    ThreadUsage usage;
    linux_extras::read_fault_and_switch_counts(usage);
    usage.cpu_time = read_thread_cpu_time();
    return usage;
}

Duration read_thread_cpu_time() noexcept
{
    timespec time{};
    const int failed = clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    TACTUS_ASSERT(failed == 0);
    return {std::int64_t{time.tv_sec} * 1'000'000'000 + std::int64_t{time.tv_nsec}};
}

namespace
{

sigset_t only_continuation() noexcept
{
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, SIGCONT);
    return only;
}

} // namespace

void watch_process_stops() noexcept
{
    const sigset_t only = only_continuation();
    const int failed = pthread_sigmask(SIG_BLOCK, &only, nullptr);
    TACTUS_ASSERT(failed == 0);
}

bool take_process_stop() noexcept
{
    sigset_t pending;
    if (sigpending(&pending) != 0 || sigismember(&pending, SIGCONT) != 1)
    {
        return false;
    }
    const sigset_t only = only_continuation();
    int taken = 0;
    return sigwait(&only, &taken) == 0; // The signal is pending, and no other thread takes it.
}

} // namespace tactus
