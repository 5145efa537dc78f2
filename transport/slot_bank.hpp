// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_pool.hpp"
#include "rt_core/spm/page_slots.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus
{

/// Slots of the transport thread, shared by all models: a slot freed by one model may be filled for
/// another. Transport thread only.
class SlotBank
{
public:
    /// All slots are free at first. `queues` must outlive the bank.
    SlotBank(Arena& arena, const PageSlots& slots, SlotQueues& queues);

    /// Bytes that the constructor takes from the arena.
    [[nodiscard]] static std::size_t required_bytes(std::size_t pages,
                                                    std::size_t index_pages) noexcept;

    /// Adds the model numbered linker.owner(), the next number from 0. `linker` must outlive the
    /// bank.
    void add(Linker& linker) { models_.push_back({&linker, {}, false}); }

    /// Takes the slots that the haptic thread freed, in order, and reports each page to the linker
    /// that filled it. The linker of a freed base mesh loses it.
    void take_back_freed();
    /// Number of freed slots taken so far, modulo 2^32; reported in each QueueEvent.
    [[nodiscard]] std::uint32_t freed_taken() const noexcept { return freed_taken_; }

    [[nodiscard]] std::size_t free_pages() const noexcept { return pages_.count; }
    [[nodiscard]] std::size_t free_index_pages() const noexcept { return index_pages_.count; }

    /// Records that the model's cells were returned without a base mesh. Requests for the mesh are
    /// outdated until the haptic thread confirms the return through `freed`.
    void expect_news_of(std::uint32_t owner) { models_[owner].is_news_due = true; }
    /// True if a request of this generation for the model's base mesh must be ignored: the mesh, or
    /// its cells, were returned later.
    [[nodiscard]] bool is_outdated(std::uint32_t owner, std::uint32_t generation) const noexcept;

    /// Slot that take_page() will take; one must be free (asserted).
    [[nodiscard]] std::uint32_t next_page() const noexcept { return pages_.next(); }
    /// Takes slot next_page() out of the free ones; its release is reported to `linker`.
    void take_page(Linker& linker) noexcept;

    [[nodiscard]] std::uint32_t next_index_page() const noexcept { return index_pages_.next(); }
    void take_index_page(std::uint32_t owner, IndexPageId page) noexcept;
    /// Slot of a model's index page, until the haptic thread frees it; otherwise IdTable::kAbsent.
    [[nodiscard]] std::uint32_t find_index_page(std::uint32_t owner,
                                                IndexPageId page) const noexcept
    {
        return index_slot_of_.find(PagePool::first_key(owner) + page.value);
    }
    /// Sizes and hashes of the chunks of the index page in `slot`.
    [[nodiscard]] std::span<ChunkEntry, kChunksPerIndexPage> entries(std::uint32_t slot) noexcept
    {
        return index_[slot].entries;
    }

private:
    struct Slots
    {
        std::span<std::uint32_t> stack;
        std::size_t count{0};

        [[nodiscard]] static Slots all_free(Arena& arena, std::size_t count) noexcept;
        [[nodiscard]] std::uint32_t next() const noexcept
        {
            TACTUS_ASSERT(count > 0);
            return stack[count - 1];
        }
    };
    struct IndexSlot
    {
        /// Key in index_slot_of_; kAbsent while the slot is free.
        std::uint32_t key{IdTable::kAbsent};
        std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    };

    struct KnownModel
    {
        Linker* linker{nullptr};
        /// Lowest valid generation of its requests, once a mesh was freed.
        std::optional<std::uint32_t> base_went;
        bool is_news_due{false};
    };

    SlotQueues& queues_;
    std::vector<KnownModel> models_; ///< Models by number.
    Slots pages_;
    Slots index_pages_;
    std::span<Linker*> linkers_; ///< Linker by page slot; null while the slot is free.
    std::span<IndexSlot> index_;
    IdTable index_slot_of_; ///< Slots by PagePool::first_key() + page.
    std::uint32_t freed_taken_{0};
};

} // namespace tactus
