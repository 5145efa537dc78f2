// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/machine_view.hpp"
#include "platform/machine/float_control.hpp"
#include "platform/machine/posix/memory_lock.hpp"
#include "platform/machine/posix/posix_error.hpp"
#include "platform/machine/system_call_trap.hpp"

#include <cstdlib>
#include <ctime>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <thread>

namespace tactus::doctor
{

namespace
{

/// Name of the user for limits.conf, which takes ":1000" for a user without a name.
std::string user_of_limits()
{
    constexpr const char* kNameless = "uid ";
    const std::string user = posix::user_name();
    return user.starts_with(kNameless) ? ":" + user.substr(4) : user;
}

template <typename Resource>
std::optional<std::uint64_t> limit_of(Resource resource)
{
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0)
    {
        return std::nullopt;
    }
    return limit.rlim_cur == RLIM_INFINITY ? kUnlimited
                                           : static_cast<std::uint64_t>(limit.rlim_cur);
}

std::string environment(const char* name)
{
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::string try_fifo()
{
    int error = 0;
    std::thread(
        [&error]
        {
            sched_param parameter{};
            parameter.sched_priority = Measured::kFifoPriority;
            error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
        })
        .join();
    return error == 0 ? "" : posix::name_of_error(error);
}

bool try_memory_lock()
{
    const bool granted = !posix::lock_all_memory();
    if (granted)
    {
        posix::unlock_all_memory();
    }
    return granted;
}

/// Counts the system calls of kClockReads clock reads. Uses a separate thread, because the trap is
/// permanent. None if calls can't be trapped.
std::optional<std::uint64_t> count_clock_calls()
{
    std::optional<std::uint64_t> calls;
    std::thread(
        [&calls]
        {
            timespec now{};
            clock_gettime(CLOCK_MONOTONIC, &now); // The first call may include the lookup of the
                                                  // function.
            if (!system_call_trap::set_on_this_thread())
            {
                return;
            }
            const std::uint64_t before = system_call_trap::of_this_thread().outside;
            for (std::uint64_t i = 0; i < Measured::kClockReads; ++i)
            {
                clock_gettime(CLOCK_MONOTONIC, &now);
            }
            calls = system_call_trap::of_this_thread().outside - before;
        })
        .join();
    return calls;
}

std::optional<std::int64_t> clock_resolution_ns()
{
    timespec resolution{};
    if (clock_getres(CLOCK_MONOTONIC, &resolution) != 0)
    {
        return std::nullopt;
    }
    return std::int64_t{resolution.tv_sec} * 1'000'000'000 + resolution.tv_nsec;
}

bool new_thread_has_default_floats()
{
    bool is_default = false;
    std::thread([&is_default] { is_default = reset_float_control(); }).join();
    return is_default;
}

} // namespace

Measured measure()
{
    Measured measured;
    measured.user = user_of_limits();
    utsname names{};
    if (uname(&names) == 0)
    {
        measured.machine = names.machine;
        measured.kernel_version = names.version;
    }
    measured.fifo_refused = try_fifo();
    measured.rtprio_limit = limit_of(RLIMIT_RTPRIO);
    measured.memory_lock_granted = try_memory_lock();
    measured.memlock_limit = limit_of(RLIMIT_MEMLOCK);
    measured.clock_calls = count_clock_calls();
    measured.clock_resolution_ns = clock_resolution_ns();
    measured.float_control_is_default = new_thread_has_default_floats();
    measured.preloaded = environment("LD_PRELOAD");
    measured.dds_uri = environment("CYCLONEDDS_URI");
    return measured;
}

} // namespace tactus::doctor
