// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/memory_lock.hpp"

#include "platform/machine/posix/linux_extras.hpp"

#include <cerrno>
#include <sys/mman.h>

namespace tactus::posix
{

std::optional<std::string> lock_all_memory()
{
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    {
        return linux_extras::explain_lock_refusal(errno);
    }
    if (const int error = linux_extras::try_to_exceed_lock_limit(); error != 0)
    {
        unlock_all_memory();
        return linux_extras::explain_lock_refusal(error);
    }
    return std::nullopt;
}

void unlock_all_memory() noexcept
{
    // munlockall() fails only without the right to lock, and then nothing is locked.
    static_cast<void>(munlockall());
}

} // namespace tactus::posix
