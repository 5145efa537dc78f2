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

/// Fixed open-addressing table from a 32-bit id to a 32-bit value (a pool slot). Each owner has its
/// own ids; the owner's number takes the upper bits of the value.
///
/// Linear probing at a load of at most one half. Erasing shifts later entries back, so there are no
/// tombstones and a probe's length depends on the present content alone. 16 B per entry of
/// capacity.
template <std::uint32_t kOwnerBits>
class BasicIdTable
{
public:
    static constexpr std::uint32_t kAbsent = 0xFFFF'FFFFU;

    struct Entry
    {
        std::uint32_t id{kAbsent};
        std::uint32_t value{kAbsent};
    };

    BasicIdTable(Arena& arena, std::uint32_t capacity) noexcept
        : entries_(arena.take<Entry>(2 * std::size_t{capacity})), capacity_(capacity)
    {
        TACTUS_ASSERT(capacity > 0 || arena.is_measuring());
        TACTUS_ASSERT(capacity <= kAbsent / 2);
        TACTUS_ASSERT(capacity <= kValues);
    }

    /// The value of an owner's id, or kAbsent.
    [[nodiscard]] std::uint32_t find(std::uint32_t id, std::uint32_t owner = 0) const noexcept
    {
        for (std::size_t at = home_of(id, owner);; at = after(at))
        {
            if (entries_[at].id == kAbsent)
            {
                return kAbsent;
            }
            if (is_of(entries_[at], id, owner))
            {
                return entries_[at].value & kValues;
            }
        }
    }

    /// Adds an id that is absent; false if the table is full.
    [[nodiscard]] bool try_insert(std::uint32_t id, std::uint32_t value,
                                  std::uint32_t owner = 0) noexcept
    {
        TACTUS_ASSERT(id != kAbsent);
        TACTUS_ASSERT(value <= kValues);
        if (size_ == capacity_)
        {
            return false;
        }
        std::size_t at = home_of(id, owner);
        for (; entries_[at].id != kAbsent; at = after(at))
        {
            TACTUS_ASSERT(!is_of(entries_[at], id, owner));
        }
        entries_[at] = {id, value | tag_of(owner)};
        ++size_;
        return true;
    }

    /// Removes an id that is present.
    void erase(std::uint32_t id, std::uint32_t owner = 0) noexcept
    {
        TACTUS_ASSERT(id != kAbsent);
        TACTUS_ASSERT(size_ > 0);
        std::size_t hole = home_of(id, owner);
        for (; !is_of(entries_[hole], id, owner); hole = after(hole))
        {
            TACTUS_ASSERT(entries_[hole].id != kAbsent);
        }
        for (std::size_t at = after(hole); entries_[at].id != kAbsent; at = after(at))
        {
            if (may_move(home_of(entries_[at].id, owner_of(entries_[at])), hole, at))
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
    static constexpr std::uint32_t kValues = kAbsent >> kOwnerBits;

    [[nodiscard]] static std::uint32_t tag_of(std::uint32_t owner) noexcept
    {
        if constexpr (kOwnerBits > 0)
        {
            TACTUS_ASSERT(owner < 1U << kOwnerBits);
            return owner << (32 - kOwnerBits);
        }
        TACTUS_ASSERT(owner == 0);
        return 0;
    }
    [[nodiscard]] static std::uint32_t owner_of([[maybe_unused]] const Entry& entry) noexcept
    {
        if constexpr (kOwnerBits > 0)
        {
            return entry.value >> (32 - kOwnerBits);
        }
        return 0;
    }
    [[nodiscard]] static bool is_of(const Entry& entry, std::uint32_t id,
                                    std::uint32_t owner) noexcept
    {
        return entry.id == id && owner_of(entry) == owner;
    }
    [[nodiscard]] std::size_t home_of(std::uint32_t id, std::uint32_t owner) const noexcept
    {
        // Fibonacci hashing, then a multiply-shift onto a table of any size.
        const std::uint32_t mixed = (id + owner * 0x85EB'CA6BU) * 0x9E37'79B9U;
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

using IdTable = BasicIdTable<0>;

} // namespace tactus
