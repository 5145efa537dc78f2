// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tactus
{

/// Bounded wait-free queue between exactly one producer thread and one consumer thread.
///
/// Head and tail count up without wrapping to the capacity; slot = count modulo capacity, so all
/// slots are usable and empty (equal) differs from full (capacity apart). Each side writes only its
/// own counter: the producer publishes a filled slot by the release store of `tail_`, the consumer
/// returns a read slot by the release store of `head_`. The slots are lent at construction and must
/// outlive the queue.
///
/// Only tests/interleave sets `Atomic` and `Slot`; it runs this code in every order that the memory
/// model allows.
template <typename T, template <typename> typename Atomic = std::atomic, typename Slot = T>
class SpscQueue
{
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit SpscQueue(std::span<Slot> slots) noexcept : slots_(slots)
    {
        TACTUS_ASSERT(!slots.empty());
    }

    /// Producer thread. False, with nothing changed, if the queue is full.
    [[nodiscard]] bool try_push(const T& value) noexcept
    {
        const std::uint64_t tail = tail_.load(std::memory_order_relaxed); // No other writer.
        // Pairs with the release in try_pop(): the slot's old content has been read.
        if (tail - head_.load(std::memory_order_acquire) == slots_.size())
        {
            return false;
        }
        slots_[static_cast<std::size_t>(tail % slots_.size())] = value;
        tail_.store(tail + 1, std::memory_order_release); // Pairs with the acquire in try_pop().
        return true;
    }

    /// Consumer thread. False, with `value` unchanged, if the queue is empty.
    [[nodiscard]] bool try_pop(T& value) noexcept
    {
        const std::uint64_t head = head_.load(std::memory_order_relaxed); // No other writer.
        // Pairs with the release in try_push(): the slot's content has been written.
        if (head == tail_.load(std::memory_order_acquire))
        {
            return false;
        }
        value = slots_[static_cast<std::size_t>(head % slots_.size())];
        head_.store(head + 1, std::memory_order_release); // Pairs with the acquire in try_push().
        return true;
    }

    /// Either thread. Number of values in the queue; exact only while neither thread uses it.
    [[nodiscard]] std::size_t size() const noexcept
    {
        // Both loads acquire, so neither count is older than the other's last hand-over.
        const std::uint64_t head = head_.load(std::memory_order_acquire);
        return static_cast<std::size_t>(tail_.load(std::memory_order_acquire) - head);
    }
    [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

private:
    std::span<Slot> slots_;
    alignas(64) Atomic<std::uint64_t> head_{0};
    alignas(64) Atomic<std::uint64_t> tail_{0};
};

} // namespace tactus
