// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"

#include <cstddef>
#include <cstring>
#include <new>
#include <span>

namespace tactus::hrtc
{

/// The memory that all pools are made of: one allocation at start-up, touched, on a cache line.
class PoolMemory
{
public:
    explicit PoolMemory(std::size_t bytes)
        : bytes_(Arena::round_up(bytes))
        , memory_(
              static_cast<std::byte*>(::operator new (bytes_, std::align_val_t{Arena::kAlignment})))
    {
        std::memset(memory_, 0, bytes_);
    }
    PoolMemory(const PoolMemory&) = delete;
    PoolMemory& operator=(const PoolMemory&) = delete;
    ~PoolMemory() { ::operator delete (memory_, std::align_val_t{Arena::kAlignment}); }

    [[nodiscard]] std::span<std::byte> span() const noexcept { return {memory_, bytes_}; }

private:
    std::size_t bytes_;
    std::byte* memory_;
};

} // namespace tactus::hrtc
