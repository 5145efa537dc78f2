// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Fixed open-addressing table from a 32-bit id to a 32-bit value (a pool slot).
///
/// Linear probing at a load of at most one half; erasing shifts later entries back, so there are no
/// tombstones and a probe's length depends on the present content alone. 16 B per entry of
/// capacity.
class IdTable
{
public:
    static constexpr std::uint32_t kAbsent = 0xFFFF'FFFFU;

    struct Entry
    {
        std::uint32_t id{kAbsent};
        std::uint32_t value{kAbsent};
    };

    IdTable(Arena& arena, std::uint32_t capacity) noexcept
        : entries_(arena.take<Entry>(2 * std::size_t{capacity})), capacity_(capacity)
    {
        TACTUS_ASSERT(capacity > 0);
        TACTUS_ASSERT(capacity <= kAbsent / 2);
    }

    /// The id's value, or kAbsent.
    [[nodiscard]] std::uint32_t find(std::uint32_t id) const noexcept
    {
        for (std::size_t at = home_of(id);; at = after(at))
        {
            if (entries_[at].id == id)
            {
                return entries_[at].value;
            }
            if (entries_[at].id == kAbsent)
            {
                return kAbsent;
            }
        }
    }

    /// Adds an id that is absent; false when the table is full.
    [[nodiscard]] bool try_insert(std::uint32_t id, std::uint32_t value) noexcept
    {
        TACTUS_ASSERT(id != kAbsent);
        if (size_ == capacity_)
        {
            return false;
        }
        std::size_t at = home_of(id);
        for (; entries_[at].id != kAbsent; at = after(at))
        {
            TACTUS_ASSERT(entries_[at].id != id);
        }
        entries_[at] = {id, value};
        ++size_;
        return true;
    }

    /// Removes an id that is present.
    void erase(std::uint32_t id) noexcept
    {
        TACTUS_ASSERT(id != kAbsent);
        TACTUS_ASSERT(size_ > 0);
        std::size_t hole = home_of(id);
        for (; entries_[hole].id != id; hole = after(hole))
        {
            TACTUS_ASSERT(entries_[hole].id != kAbsent);
        }
        for (std::size_t at = after(hole); entries_[at].id != kAbsent; at = after(at))
        {
            if (may_move(home_of(entries_[at].id), hole, at))
            {
                entries_[hole] = entries_[at];
                hole = at;
            }
        }
        entries_[hole] = Entry{};
        --size_;
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
    [[nodiscard]] std::uint32_t capacity() const noexcept { return capacity_; }

private:
    [[nodiscard]] std::size_t home_of(std::uint32_t id) const noexcept
    {
        // Fibonacci hashing, then a multiply-shift onto a table of any size.
        const std::uint32_t mixed = id * 0x9E37'79B9U;
        return static_cast<std::size_t>((std::uint64_t{mixed} * entries_.size()) >> 32U);
    }
    [[nodiscard]] std::size_t after(std::size_t at) const noexcept
    {
        return at + 1 == entries_.size() ? 0 : at + 1;
    }
    /// An entry at `at` may fill `hole` unless its home lies cyclically within (hole, at].
    [[nodiscard]] static bool may_move(std::size_t home, std::size_t hole, std::size_t at) noexcept
    {
        return hole <= at ? (home <= hole || home > at) : (home <= hole && home > at);
    }

    std::span<Entry> entries_;
    std::uint32_t capacity_;
    std::uint32_t size_{0};
};

} // namespace tactus
