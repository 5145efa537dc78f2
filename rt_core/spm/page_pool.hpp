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

/// What of a page slot is shown to viewers.
struct ShownPage
{
    ChunkId chunk{};        ///< None: the slot is the transport thread's.
    std::uint32_t owner{0}; ///< The model that had the slot last.
    static_assert(kRecordsPerChunk <= 64);
    std::uint64_t refined{0}; ///< One bit a record. The page is pinned while any is set.

    bool operator==(const ShownPage&) const noexcept = default;
};
static_assert(sizeof(ShownPage) == 16);

/// What the haptic thread knows of a page slot.
struct PageMeta : ShownPage
{
    std::uint64_t held{0};    ///< Refined for a closure that isn't complete; not to be merged.
    std::uint64_t linked{0};  ///< As the inbox has told so far; the linker may know of more.
    std::uint32_t touched{0}; ///< Frame number of the last use.
};

/// Which chunk of which model is in which slot, for the page tables of all models. 56 B a page.
/// Haptic thread only.
struct PagePool
{
    PagePool(Arena& arena, std::uint32_t slots) noexcept
        : slot_of(arena, slots)
        , metas(arena.take<PageMeta>(slots))
        , changed_(arena.take<std::uint64_t>((std::size_t{slots} + kWord - 1) / kWord))
    {
    }

    /// A model's chunks are numbered from here on.
    [[nodiscard]] static constexpr std::uint32_t first_key(std::uint32_t owner) noexcept
    {
        return owner << kKeyBits;
    }

    /// What is shown of the slot is another than it was; whoever changes it says so.
    void mark_changed(std::uint32_t slot) noexcept
    {
        changed_[slot / kWord] |= std::uint64_t{1} << (slot % kWord);
    }
    /// Brings a copy of the first slots up to date, which was so at the last call: 9 instructions
    /// for 64 slots, and 16 for each one that was marked since. There is one such copy, made once
    /// from `metas` as they were.
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

    IdTable slot_of; ///< By first_key() + chunk.
    std::span<PageMeta> metas;

private:
    static constexpr std::uint32_t kWord = 64;
    static constexpr std::uint32_t kKeyBits = 29 - kRecordsPerChunkLog2;
    static_assert(kMaxRecords >> kRecordsPerChunkLog2 < 1U << kKeyBits);
    static_assert(kMaxModels <= 1U << (32 - kKeyBits));

    std::span<std::uint64_t> changed_; ///< A bit a slot.
};

} // namespace tactus
