// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/pool_memory.hpp"
#include "platform/machine/posix/linux_extras.hpp"
#include "platform/machine/posix/memory_lock.hpp"
#include "rt_core/base/arena.hpp"

#include <cerrno>
#include <cstring>
#include <new>
#include <sys/mman.h>

namespace tactus
{

namespace
{

constexpr std::align_val_t kAlignment{PoolMemory::kHugePage};

std::size_t whole_huge_pages(std::size_t bytes)
{
    return (bytes + PoolMemory::kHugePage - 1) / PoolMemory::kHugePage * PoolMemory::kHugePage;
}

} // namespace

PoolMemory::PoolMemory(std::size_t bytes)
    : bytes_(Arena::round_up(bytes))
    , memory_(static_cast<std::byte*>(::operator new(whole_huge_pages(bytes_), kAlignment)))
{
    linux_extras::ask_for_huge_pages({memory_, whole_huge_pages(bytes_)});
    std::memset(memory_, 0, bytes_);
}

PoolMemory::~PoolMemory()
{
    ::operator delete(memory_, kAlignment);
}

} // namespace tactus

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
