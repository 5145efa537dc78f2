// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/posix/memory_lock.hpp"

#include "platform/posix/posix_error.hpp"

#include <cerrno>
#include <sys/mman.h>
#include <sys/resource.h>

namespace tactus::posix
{

namespace
{

std::string explain_refusal(int error, const rlimit& limit)
{
    const std::string amount =
        limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur) + " bytes";
    return "mlockall refused (" + name_of_error(error) + "): RLIMIT_MEMLOCK is " + amount +
           " and memory mapped later must fit as well; add '" + user_name() +
           " - memlock unlimited' to /etc/security/limits.conf and log in again, or give "
           "CAP_IPC_LOCK (container: --cap-add=IPC_LOCK --ulimit memlock=-1)";
}

/// With future memory locked, the system checks a new mapping against the limit before anything
/// else, so mapping more than the limit, without access and so without pages, tells whether the
/// limit binds this process. Returns 0 or the errno.
int try_to_exceed(rlim_t limit) noexcept
{
    const auto bytes = static_cast<std::size_t>(limit) + 4096;
    void* mapped = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED)
    {
        return errno;
    }
    return munmap(mapped, bytes) == 0 ? 0 : errno;
}

} // namespace

std::optional<std::string> lock_all_memory()
{
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0)
    {
        limit.rlim_cur = RLIM_INFINITY;
    }
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    {
        return explain_refusal(errno, limit);
    }
    const int error = limit.rlim_cur == RLIM_INFINITY ? 0 : try_to_exceed(limit.rlim_cur);
    if (error != 0)
    {
        unlock_all_memory();
        return explain_refusal(error, limit);
    }
    return std::nullopt;
}

void unlock_all_memory() noexcept
{
    // It can only fail for want of the right to lock, and then nothing is locked.
    static_cast<void>(munlockall());
}

} // namespace tactus::posix
