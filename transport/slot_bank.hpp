// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/cache/slot_door.hpp"
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

/// The transport thread's slots: one that a model gave back is for whichever has a piece next.
/// Transport thread only.
class SlotBank
{
public:
    /// All slots are free. `door` must outlive the bank.
    SlotBank(Arena& arena, const PageSlots& slots, SlotDoor& door);

    /// Bytes that the constructor takes from the arena.
    [[nodiscard]] static std::size_t required_bytes(std::size_t pages,
                                                    std::size_t index_pages) noexcept;

    /// One model more, by its owner's number; it must outlive the bank.
    void add(Linker& linker) { models_.push_back({&linker, {}, false}); }

    /// Slots that the haptic thread has no more use for are free again, in its order, and unknown
    /// to those who filled them; models whose base mesh went have none any more.
    void take_back_freed();
    /// How many were, modulo 2^32, as in DoorEvent.
    [[nodiscard]] std::uint32_t freed_taken() const noexcept { return freed_taken_; }

    [[nodiscard]] std::size_t free_pages() const noexcept { return pages_.count; }
    [[nodiscard]] std::size_t free_index_pages() const noexcept { return index_pages_.count; }

    /// The cells for the model's base mesh were given back: wishes for it are outdated until the
    /// haptic thread says that it has them.
    void expect_news_of(std::uint32_t owner) { models_[owner].is_news_due = true; }
    /// Whether a wish for the model's base mesh is of the time before it, or its cells, went.
    [[nodiscard]] bool is_outdated(std::uint32_t owner, std::uint32_t generation) const noexcept;

    /// The slot that take_page() gives; one is free (asserted).
    [[nodiscard]] std::uint32_t next_page() const noexcept { return pages_.next(); }
    /// `linker` is told when the slot is taken back.
    void take_page(Linker& linker) noexcept;

    [[nodiscard]] std::uint32_t next_index_page() const noexcept { return index_pages_.next(); }
    void take_index_page(std::uint32_t owner, IndexPageId page) noexcept;
    /// The slot of a model's index page until it is taken back, or IdTable::kAbsent.
    [[nodiscard]] std::uint32_t find_index_page(std::uint32_t owner,
                                                IndexPageId page) const noexcept
    {
        return index_slot_of_.find(PagePool::first_key(owner) + page.value);
    }
    /// What verifies the chunks of an index page, in its slot, which there must be.
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
        std::uint32_t key{IdTable::kAbsent}; ///< In index_slot_of_; none while it is free.
        std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    };

    struct KnownModel
    {
        Linker* linker{nullptr};
        std::optional<std::uint32_t> base_went; ///< The generation of that.
        bool is_news_due{false};
    };

    SlotDoor& door_;
    std::vector<KnownModel> models_; ///< By owner.
    Slots pages_;
    Slots index_pages_;
    std::span<Linker*> linkers_; ///< By page slot; null while it is free.
    std::span<IndexSlot> index_;
    IdTable index_slot_of_; ///< By PagePool::first_key() + page.
    std::uint32_t freed_taken_{0};
};

} // namespace tactus
