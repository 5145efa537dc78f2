// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/pool_memory.hpp"

#include "platform/machine/posix/linux_extras.hpp"
#include "rt_core/base/arena.hpp"

#include <cstring>
#include <new>

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
