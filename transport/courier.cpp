// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/courier.hpp"

#include "rt_core/spm/chunk_coding.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus
{

namespace
{

/// Generations count up and may wrap: whether `a` is older than `b`.
bool is_older(std::uint32_t a, std::uint32_t b) noexcept
{
    return static_cast<std::int32_t>(a - b) < 0;
}

} // namespace

Courier::Courier(Arena& arena, const ModelHeader& header, const PageSlots& slots, Linker& linker,
                 ChunkInbox& inbox, ChunkLink& link, std::string name, Log log,
                 const CourierOptions& options)
    : header_(header)
    , counts_(header.counts())
    , slots_(slots)
    , linker_(linker)
    , inbox_(inbox)
    , link_(link)
    , name_(std::move(name))
    , log_(std::move(log))
    , options_(options)
    , free_pages_(all_free(arena, slots.pages.size()))
    , free_index_(all_free(arena, slots.index_pages.size()))
    , index_(arena.take<IndexSlot>(slots.index_pages.size()))
    , index_slot_of_(arena, static_cast<std::uint32_t>(slots.index_pages.size()) + 1)
    , open_(arena.take<OpenWish>(options.open_wishes))
    , batch_(arena.take<ContentKey>(options.open_wishes))
    , session_(link.session())
{
    TACTUS_ASSERT(options.open_wishes > 0);
}

void Courier::step(std::int64_t now_ns)
{
    now_ns_ = now_ns;
    // Counted before the freed slots are taken back: the haptic thread frees a page before it
    // wishes for it anew, so each of these wishes sees the freeing that came before it.
    const std::size_t wishes = inbox_.wanted.size();
    take_back_freed();
    take_wishes(wishes);
    ask();
    link_.poll(*this);
    push_link_updates();
}

void Courier::take_back_freed()
{
    ChunkInbox::Freed freed;
    while (inbox_.freed.try_pop(freed))
    {
        ++freed_taken_;
        const bool is_page = freed.kind == ContentKind::chunk;
        Slots& free = is_page ? free_pages_ : free_index_;
        TACTUS_ASSERT(free.count < free.stack.size() && freed.slot < free.stack.size());
        if (is_page)
        {
            linker_.release_page(freed.slot);
        }
        else
        {
            TACTUS_ASSERT(!index_[freed.slot].page.is_none());
            index_slot_of_.erase(index_[freed.slot].page.value);
            index_[freed.slot].page = {};
        }
        free.stack[free.count++] = freed.slot;
    }
}

void Courier::take_wishes(std::size_t count)
{
    ChunkInbox::Wish wish;
    for (std::size_t i = 0; i < count && inbox_.wanted.try_pop(wish); ++i)
    {
        ++counters_.wishes;
        open_wish(wish);
    }
}

void Courier::open_wish(const ChunkInbox::Wish& wish)
{
    TACTUS_ASSERT(is_key_of_model(wish.key));
    newest_generation_ =
        is_older(newest_generation_, wish.generation) ? wish.generation : newest_generation_;
    if (is_resident(wish.key))
    {
        return; // On its way through the door: it was wished for twice.
    }
    if (OpenWish* open = find_open(wish.key); open != nullptr)
    {
        open->generation = wish.generation;
        ask_again(*open); // The cache has waited long enough for an answer.
        return;
    }
    if (open_count_ == open_.size())
    {
        forget_oldest_generation();
    }
    open_[open_count_++] = {wish.key, wish.generation, false, now_ns_};
}

void Courier::forget_oldest_generation()
{
    std::size_t oldest = 0;
    for (std::size_t i = 1; i < open_count_; ++i)
    {
        oldest = is_older(open_[i].generation, open_[oldest].generation) ? i : oldest;
    }
    open_[oldest] = open_[--open_count_];
    ++counters_.forgotten;
}

void Courier::ask_again(OpenWish& open)
{
    counters_.asked_again += open.is_asked ? 1 : 0;
    open.is_asked = false;
}

/// What hasn't been asked for yet, and everything again when another host serves the model. How
/// long to wait for an answer is the cache's to know: a wish has one clock, WishList's. Loss is the
/// link's business first; wishes expire for what it cannot see: pieces that were damaged, or found
/// no slot.
void Courier::ask()
{
    const std::span<OpenWish> open = open_.first(open_count_);
    if (link_.session() != session_)
    {
        session_ = link_.session();
        std::ranges::for_each(open, [this](OpenWish& wish) { ask_again(wish); });
    }
    if (link_.state() == LinkState::host_gone)
    {
        return;
    }
    std::size_t count = 0;
    for (OpenWish& wish : open)
    {
        if (!wish.is_asked)
        {
            wish.is_asked = true;
            batch_[count++] = wish.key;
        }
    }
    if (count > 0)
    {
        link_.request(batch_.first(count), newest_generation_);
    }
}

void Courier::receive(ContentKey key, std::span<const std::byte> bytes)
{
    ++counters_.pieces;
    counters_.coded_bytes += bytes.size();
    if (find_open(key) == nullptr)
    {
        ++counters_.dropped_unasked;
        return;
    }
    if (key.kind == ContentKind::index_page)
    {
        adopt_index_page({key.number}, bytes);
    }
    else
    {
        adopt_chunk({key.number}, bytes);
    }
}

void Courier::adopt_index_page(IndexPageId page, std::span<const std::byte> bytes)
{
    const ContentKey key{ContentKind::index_page, page.value};
    if (content_hash(bytes) != header_.index_entry(page).hash)
    {
        refuse(counters_.refused_hash, key, "does not have the hash that the header names");
        return;
    }
    if (free_index_.count == 0)
    {
        ++counters_.dropped_no_slot;
        close_wish(key);
        return;
    }
    const std::uint32_t slot = free_index_.stack[free_index_.count - 1];
    if (auto done =
            parse_index_page(bytes, counts_, page, slots_.index_pages[slot], index_[slot].entries);
        !done)
    {
        refuse(counters_.refused_content, key, refusal_text(done.error()));
        close_wish(key); // The host has no better one.
        return;
    }
    --free_index_.count;
    index_[slot].page = page;
    const bool inserted = index_slot_of_.try_insert(page.value, slot);
    TACTUS_ASSERT(inserted);
    hand_over(key, slot, 0, bytes);
}

void Courier::adopt_chunk(ChunkId chunk, std::span<const std::byte> bytes)
{
    const ContentKey key{ContentKind::chunk, chunk.value};
    const std::uint32_t index_slot = index_slot_of_.find(chunk.value >> kChunksPerIndexPageLog2);
    if (index_slot == IdTable::kAbsent)
    {
        ++counters_.dropped_no_index;
        close_wish(key);
        return;
    }
    const ChunkEntry& entry = index_[index_slot].entries[chunk.value % kChunksPerIndexPage];
    if (bytes.size() != entry.coded_bytes || content_hash(bytes) != entry.hash)
    {
        refuse(counters_.refused_hash, key, "does not have the hash that its index page names");
        return;
    }
    if (free_pages_.count == 0)
    {
        ++counters_.dropped_no_slot;
        close_wish(key);
        return;
    }
    const std::uint32_t slot = free_pages_.stack[free_pages_.count - 1];
    if (auto done = parse_chunk(bytes, header_, chunk, slots_.pages[slot]); !done)
    {
        refuse(counters_.refused_content, key, refusal_text(done.error()));
        close_wish(key);
        return;
    }
    --free_pages_.count;
    linker_.link_page(chunk, slot);
    hand_over(key, slot, linker_.tell_linked(slot), bytes);
}

void Courier::hand_over(ContentKey key, std::uint32_t slot, std::uint64_t linked,
                        std::span<const std::byte> bytes)
{
    if (copies_ != nullptr)
    {
        copies_->receive(key, bytes);
    }
    const OpenWish* open = find_open(key);
    TACTUS_ASSERT(open != nullptr);
    waiting_times_.add(now_ns_ - open->opened_ns);
    close_wish(key);
    // Room for every slot: a slot is in at most one queue.
    const bool pushed = inbox_.arrived.try_push({key, slot, freed_taken_, linked});
    TACTUS_ASSERT(pushed);
    ++counters_.delivered;
}

/// After the arrivals that linked them, so that the door's order is that of linking.
void Courier::push_link_updates()
{
    Linker::Update update;
    while (inbox_.has_room_for_update() && linker_.try_take_update(update))
    {
        const bool pushed = inbox_.arrived.try_push({{ContentKind::chunk, update.chunk.value},
                                                     update.slot,
                                                     freed_taken_,
                                                     update.linked,
                                                     DoorEventKind::link_update});
        TACTUS_ASSERT(pushed);
    }
}

void Courier::refuse(std::uint64_t& counter, ContentKey key, const char* reason)
{
    ++counter;
    if (log_.try_begin())
    {
        log_.write_now(fmt::format("model '{}': {} {} {}; refused, nothing changed", name_,
                                   key.kind == ContentKind::chunk ? "chunk" : "index page",
                                   key.number, reason));
    }
}

Courier::OpenWish* Courier::find_open(ContentKey key) noexcept
{
    const std::span<OpenWish> open = open_.first(open_count_);
    const auto found = std::ranges::find(open, key, &OpenWish::key);
    return found == open.end() ? nullptr : &*found;
}

void Courier::close_wish(ContentKey key) noexcept
{
    if (OpenWish* open = find_open(key); open != nullptr)
    {
        *open = open_[--open_count_];
    }
}

bool Courier::is_resident(ContentKey key) const noexcept
{
    return key.kind == ContentKind::chunk ? linker_.is_resident({key.number})
                                          : index_slot_of_.find(key.number) != IdTable::kAbsent;
}

bool Courier::is_key_of_model(ContentKey key) const noexcept
{
    return key.kind == ContentKind::chunk        ? key.number < counts_.chunks()
           : key.kind == ContentKind::index_page ? key.number < counts_.index_pages()
                                                 : false;
}

std::size_t Courier::required_bytes(std::size_t pages, std::size_t index_pages,
                                    const CourierOptions& options) noexcept
{
    Arena arena = Arena::measuring();
    static_cast<void>(all_free(arena, pages));
    static_cast<void>(all_free(arena, index_pages));
    static_cast<void>(arena.take<IndexSlot>(index_pages));
    const IdTable table(arena, static_cast<std::uint32_t>(index_pages) + 1);
    static_cast<void>(arena.take<OpenWish>(options.open_wishes));
    static_cast<void>(arena.take<ContentKey>(options.open_wishes));
    return arena.used();
}

Courier::Slots Courier::all_free(Arena& arena, std::size_t count) noexcept
{
    Slots slots{arena.take<std::uint32_t>(count), count};
    for (std::size_t i = 0; !arena.is_measuring() && i < slots.stack.size(); ++i)
    {
        slots.stack[i] = static_cast<std::uint32_t>(count - 1 - i); // Slot 0 is handed out first.
    }
    return slots;
}

} // namespace tactus
