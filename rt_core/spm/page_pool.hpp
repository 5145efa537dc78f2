// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/spm/ids.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Part of a page slot's state that viewers see.
struct ShownPage
{
    ChunkId chunk{};        ///< None: the slot is the transport thread's.
    std::uint32_t owner{0}; ///< The model that had the slot last.
    static_assert(kRecordsPerChunk <= 64);
    std::uint64_t refined{0}; ///< Split records, one bit each; any bit pins the page.

    bool operator==(const ShownPage&) const noexcept = default;
};
static_assert(sizeof(ShownPage) == 16);

/// State of a page slot on the haptic thread.
struct PageMeta : ShownPage
{
    std::uint64_t held{0};    ///< Records held for an incomplete closure, one bit each.
    std::uint64_t linked{0};  ///< Bits reported by the linker, which may be ahead.
    std::uint32_t touched{0}; ///< Frame number of the last use.
};

/// Slot of each resident chunk of all models, shared by their page tables. 56 B per page. Haptic
/// thread only.
struct PagePool
{
    PagePool(Arena& arena, std::uint32_t slots) noexcept
        : slot_of(arena, slots)
        , metas(arena.take<PageMeta>(slots))
        , changed_(arena.take<std::uint64_t>((std::size_t{slots} + kWord - 1) / kWord))
    {
    }

    /// Key of a model's chunk 0 in slot_of; further chunks follow.
    [[nodiscard]] static constexpr std::uint32_t first_key(std::uint32_t owner) noexcept
    {
        return owner << kKeyBits;
    }

    /// Marks a slot for update_copy(). Callers must call it after each change of its ShownPage.
    void mark_changed(std::uint32_t slot) noexcept
    {
        changed_[slot / kWord] |= std::uint64_t{1} << (slot % kWord);
    }
    /// Updates a copy of the first slots: copies those marked since the last call and clears their
    /// marks. 9 instructions per 64 slots, and 16 for each marked one. Only one copy may exist,
    /// first made from `metas`.
    void update_copy(std::span<ShownPage> copy) noexcept
    {
        const std::size_t words = std::min(changed_.size(), (copy.size() + kWord - 1) / kWord);
        for (std::size_t word = 0; word < words; ++word)
        {
            for (std::uint64_t left = changed_[word]; left != 0; left &= left - 1)
            {
                const std::size_t slot =
                    word * kWord + static_cast<std::size_t>(std::countr_zero(left));
                if (slot < copy.size())
                {
                    copy[slot] = metas[slot];
                }
            }
            changed_[word] = 0;
        }
    }

    IdTable slot_of; ///< Key: first_key() + chunk.
    std::span<PageMeta> metas;

private:
    static constexpr std::uint32_t kWord = 64;
    static constexpr std::uint32_t kKeyBits = 29 - kRecordsPerChunkLog2;
    static_assert(kMaxRecords >> kRecordsPerChunkLog2 < 1U << kKeyBits);
    static_assert(kMaxModels <= 1U << (32 - kKeyBits));

    std::span<std::uint64_t> changed_; ///< One bit per slot.
};

} // namespace tactus
