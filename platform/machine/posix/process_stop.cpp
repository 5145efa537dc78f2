// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/process_stop.hpp"

#include "rt_core/base/assert.hpp"

#include <csignal>

namespace tactus
{

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
