// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/thread_usage.hpp"

#include "platform/machine/posix/linux_extras.hpp"
#include "rt_core/base/assert.hpp"

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

} // namespace tactus
