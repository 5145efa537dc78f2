// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// What of a page slot is shown to viewers: one register's worth, so that copying all is cheap.
struct ShownPage
{
    ChunkId chunk{};        ///< None: the slot is the transport thread's.
    std::uint32_t owner{0}; ///< The model that had the slot last.
    static_assert(kRecordsPerChunk <= 64);
    std::uint64_t refined{0}; ///< One bit a record. The page is pinned while any is set.
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
        : slot_of(arena, slots), metas(arena.take<PageMeta>(slots))
    {
    }

    /// A model's chunks are numbered from here on.
    [[nodiscard]] static constexpr std::uint32_t first_key(std::uint32_t owner) noexcept
    {
        return owner << kKeyBits;
    }

    IdTable slot_of; ///< By first_key() + chunk.
    std::span<PageMeta> metas;

private:
    static constexpr std::uint32_t kKeyBits = 29 - kRecordsPerChunkLog2;
    static_assert(kMaxRecords >> kRecordsPerChunkLog2 < 1U << kKeyBits);
    static_assert(kMaxModels <= 1U << (32 - kKeyBits));
};

} // namespace tactus
