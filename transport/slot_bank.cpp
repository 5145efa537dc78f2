// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/slot_bank.hpp"

#include <utility>

namespace tactus
{

SlotBank::Slots SlotBank::Slots::all_free(Arena& arena, std::size_t count) noexcept
{
    Slots slots{arena.take<std::uint32_t>(count), count};
    for (std::size_t i = 0; !arena.is_measuring() && i < slots.stack.size(); ++i)
    {
        slots.stack[i] = static_cast<std::uint32_t>(count - 1 - i); // Slot 0 is taken first.
    }
    return slots;
}

SlotBank::SlotBank(Arena& arena, const PageSlots& slots, SlotQueues& queues)
    : queues_(queues)
    , pages_(Slots::all_free(arena, slots.pages.size()))
    , index_pages_(Slots::all_free(arena, slots.index_pages.size()))
    , linkers_(arena.take<Linker*>(slots.pages.size()))
    , index_(arena.take<IndexSlot>(slots.index_pages.size()))
    , index_slot_of_(arena, static_cast<std::uint32_t>(slots.index_pages.size()))
{
}

std::size_t SlotBank::required_bytes(std::size_t pages, std::size_t index_pages) noexcept
{
    Arena arena = Arena::measuring();
    static_cast<void>(Slots::all_free(arena, pages));
    static_cast<void>(Slots::all_free(arena, index_pages));
    static_cast<void>(arena.take<Linker*>(pages));
    static_cast<void>(arena.take<IndexSlot>(index_pages));
    const IdTable table(arena, static_cast<std::uint32_t>(index_pages));
    return arena.used();
}

void SlotBank::take_back_freed()
{
    FreedSlot freed;
    while (queues_.freed.try_pop(freed))
    {
        ++freed_taken_;
        if (freed.kind == ContentKind::base)
        {
            TACTUS_ASSERT(freed.slot < models_.size());
            models_[freed.slot].linker->set_base({});
            models_[freed.slot].base_went = freed.generation;
            models_[freed.slot].is_news_due = false;
            continue;
        }
        const bool is_page = freed.kind == ContentKind::chunk;
        Slots& free = is_page ? pages_ : index_pages_;
        TACTUS_ASSERT(free.count < free.stack.size());
        TACTUS_ASSERT(freed.slot < free.stack.size());
        if (is_page)
        {
            TACTUS_ASSERT(linkers_[freed.slot] != nullptr);
            std::exchange(linkers_[freed.slot], nullptr)->release_page(freed.slot);
        }
        else
        {
            IndexSlot& slot = index_[freed.slot];
            index_slot_of_.erase(std::exchange(slot.key, IdTable::kAbsent));
        }
        free.stack[free.count++] = freed.slot;
    }
}

/// Generations count up and may wrap.
bool SlotBank::is_outdated(std::uint32_t owner, std::uint32_t generation) const noexcept
{
    const KnownModel& model = models_[owner];
    return model.is_news_due ||
           (model.base_went && static_cast<std::int32_t>(generation - *model.base_went) < 0);
}

void SlotBank::take_page(Linker& linker) noexcept
{
    linkers_[next_page()] = &linker;
    --pages_.count;
}

void SlotBank::take_index_page(std::uint32_t owner, IndexPageId page) noexcept
{
    const std::uint32_t key = PagePool::first_key(owner) + page.value;
    index_[next_index_page()].key = key;
    const bool inserted = index_slot_of_.try_insert(key, next_index_page());
    TACTUS_ASSERT(inserted);
    --index_pages_.count;
}

} // namespace tactus
