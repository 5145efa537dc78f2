// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/thread_stack.hpp"

#include <cstring>
#include <sys/mman.h>
#include <unistd.h>

namespace tactus::posix
{

ThreadStack::ThreadStack(std::size_t bytes) noexcept
{
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t usable = (bytes + page - 1) / page * page;
    void* start =
        mmap(nullptr, usable + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED)
    {
        return;
    }
    mapped_ = {static_cast<std::byte*>(start), usable + page};
    if (mprotect(start, page, PROT_NONE) != 0)
    {
        return;
    }
    memory_ = mapped_.subspan(page);
    std::memset(memory_.data(), 0, memory_.size());
}

ThreadStack::~ThreadStack()
{
    if (!mapped_.empty())
    {
        // munmap() of a whole mapping can't fail.
        static_cast<void>(munmap(mapped_.data(), mapped_.size()));
    }
}

} // namespace tactus::posix
