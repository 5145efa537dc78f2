// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>

// One thread, before the loop; no call waits or allocates.
namespace tactus
{

/// Hands out parts of one span of memory that was lent at start-up; parts are not returned singly.
/// The memory outlives the arena and all parts taken from it; no destructor of a value runs.
///
/// A measuring arena only counts: its spans have a size but no memory. A pool built on one reports
/// how many bytes it needs and must not be used; constructors that fill their memory return first
/// if `is_measuring()`.
class Arena
{
public:
    /// The strictest alignment an arena serves; the lent span must start on it.
    static constexpr std::size_t kAlignment = 64;

    explicit Arena(std::span<std::byte> memory) noexcept : memory_(memory)
    {
        TACTUS_ASSERT(reinterpret_cast<std::uintptr_t>(memory.data()) % kAlignment == 0);
    }

    static Arena measuring() noexcept { return Arena{{}}; }
    [[nodiscard]] bool is_measuring() const noexcept { return memory_.data() == nullptr; }

    /// `count` default-constructed values, starting on a cache line of their own. Too little memory
    /// is a bug (asserted): sizes are measured beforehand.
    template <typename T>
    [[nodiscard]] std::span<T> take(std::size_t count) noexcept
    {
        static_assert(alignof(T) <= kAlignment);
        const std::size_t start = used_;
        used_ = round_up(start + count * sizeof(T));
        if (is_measuring())
        {
            return {static_cast<T*>(nullptr), count};
        }
        TACTUS_ASSERT(used_ <= memory_.size());
        T* first = reinterpret_cast<T*>(memory_.data() + start);
        for (std::size_t i = 0; i < count; ++i)
        {
            ::new (static_cast<void*>(first + i)) T();
        }
        return {first, count};
    }

    /// Bytes handed out, including the padding of their cache lines.
    [[nodiscard]] std::size_t used() const noexcept { return used_; }
    /// Bytes not handed out yet; none when measuring.
    [[nodiscard]] std::size_t left() const noexcept
    {
        return is_measuring() ? 0 : memory_.size() - used_;
    }

    /// Size rounded up to whole cache lines.
    [[nodiscard]] static constexpr std::size_t round_up(std::size_t bytes) noexcept
    {
        return (bytes + kAlignment - 1) / kAlignment * kAlignment;
    }

private:
    std::span<std::byte> memory_;
    std::size_t used_{0};
};

} // namespace tactus
