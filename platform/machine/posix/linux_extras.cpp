// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/linux_extras.hpp"

#include "platform/machine/posix/posix_error.hpp"
#include "rt_core/base/assert.hpp"

#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace tactus::linux_extras
{

namespace
{

std::string describe_rtprio_limit(const rlimit& limit)
{
    return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

/// Limit of locked memory in bytes; RLIM_INFINITY if the system has no answer.
rlim_t lock_limit_bytes() noexcept
{
    rlimit limit{};
    return getrlimit(RLIMIT_MEMLOCK, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

/// Processors of this process, for instance "0-1,3".
std::string allowed_cpus()
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof(set), &set) != 0)
    {
        return "unknown";
    }
    std::string list;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    {
        const int first = cpu;
        while (cpu < CPU_SETSIZE && CPU_ISSET(static_cast<std::size_t>(cpu), &set))
        {
            ++cpu;
        }
        if (cpu == first)
        {
            continue;
        }
        list += (list.empty() ? "" : ",") + std::to_string(first);
        list += cpu - first > 1 ? "-" + std::to_string(cpu - 1) : "";
    }
    return list;
}

} // namespace

int pin_calling_thread(int cpu) noexcept
{
    if (cpu < 0 || cpu >= CPU_SETSIZE)
    {
        return EINVAL;
    }
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(cpu), &set);
    return pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
}

void keep_calling_thread_off(int cpu) noexcept
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (!another_cpu(cpu) || sched_getaffinity(0, sizeof(set), &set) != 0)
    {
        return;
    }
    CPU_CLR(static_cast<std::size_t>(cpu), &set);
    static_cast<void>(pthread_setaffinity_np(pthread_self(), sizeof(set), &set));
}

void let_calling_thread_use_all() noexcept
{
    cpu_set_t set;
    CPU_ZERO(&set);
    for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    {
        CPU_SET(cpu, &set);
    }
    static_cast<void>(pthread_setaffinity_np(pthread_self(), sizeof(set), &set));
}

std::string explain_pin_refusal(int cpu)
{
    return "processor " + std::to_string(cpu) + " can't be used by this process; it may use " +
           allowed_cpus();
}

std::optional<int> another_cpu(int cpu) noexcept
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof(set), &set) != 0)
    {
        return std::nullopt;
    }
    for (int other = 0; other < CPU_SETSIZE; ++other)
    {
        if (other != cpu && CPU_ISSET(static_cast<std::size_t>(other), &set))
        {
            return other;
        }
    }
    return std::nullopt;
}

std::string explain_fifo_refusal(int priority, int error)
{
    std::string line = "SCHED_FIFO " + std::to_string(priority) + " refused (" +
                       posix::name_of_error(error) + "): ";
    rlimit limit{};
    const bool known = getrlimit(RLIMIT_RTPRIO, &limit) == 0;
    if (known && limit.rlim_cur >= static_cast<rlim_t>(priority))
    {
        return line + "RLIMIT_RTPRIO is " + describe_rtprio_limit(limit) +
               " and would allow it, so the control group has no real-time share; give it one "
               "(cpu.rt_runtime_us) or start the process in the root cpu group";
    }
    return line + "RLIMIT_RTPRIO is " + (known ? describe_rtprio_limit(limit) : "unknown") +
           "; add '" + posix::user_name() +
           " - rtprio 99' to /etc/security/limits.d/tactus.conf and log in again, or give "
           "CAP_SYS_NICE "
           "(container: --cap-add=SYS_NICE)";
}

int try_to_exceed_lock_limit() noexcept
{
    const rlim_t limit = lock_limit_bytes();
    if (limit == RLIM_INFINITY)
    {
        return 0;
    }
    // While future memory is locked, the system checks each new mapping against the limit first.
    const auto bytes = static_cast<std::size_t>(limit) + 4096;
    void* mapped = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED)
    {
        return errno;
    }
    return munmap(mapped, bytes) == 0 ? 0 : errno;
}

std::string explain_lock_refusal(int error)
{
    const rlim_t limit = lock_limit_bytes();
    const std::string amount =
        limit == RLIM_INFINITY ? "unlimited" : std::to_string(limit) + " bytes";
    return "mlockall refused (" + posix::name_of_error(error) + "): RLIMIT_MEMLOCK is " + amount +
           ", but memory that is mapped later counts too; add '" + posix::user_name() +
           " - memlock unlimited' to /etc/security/limits.d/tactus.conf and log in again, or give "
           "CAP_IPC_LOCK (container: --cap-add=IPC_LOCK --ulimit memlock=-1)";
}

void read_fault_and_switch_counts(ThreadUsage& usage) noexcept
{
    rusage found{};
    const int failed = getrusage(RUSAGE_THREAD, &found);
    TACTUS_ASSERT(failed == 0);
    usage.minor_faults = found.ru_minflt;
    usage.major_faults = found.ru_majflt;
    usage.voluntary_switches = found.ru_nvcsw;
    usage.involuntary_switches = found.ru_nivcsw;
}

void ask_for_huge_pages(std::span<std::byte> memory) noexcept
{
    // Refusal is harmless: a kernel without such pages gives small ones.
    static_cast<void>(madvise(memory.data(), memory.size(), MADV_HUGEPAGE));
}

bool draw_random(std::span<std::byte> bytes) noexcept
{
    return getentropy(bytes.data(), bytes.size()) == 0;
}

AwakeProcessors::AwakeProcessors() noexcept
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library has no other.
    : descriptor_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC))
{
    constexpr std::int32_t kLongestWake_us = 0;
    if (descriptor_ >= 0 &&
        write(descriptor_, &kLongestWake_us, sizeof(kLongestWake_us)) != sizeof(kLongestWake_us))
    {
        close(descriptor_);
        descriptor_ = -1;
    }
}

AwakeProcessors::~AwakeProcessors()
{
    if (descriptor_ >= 0)
    {
        close(descriptor_);
    }
}

} // namespace tactus::linux_extras
