// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/chunk_loader.hpp"

#include "rt_core/spm/chunk_coding.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus
{

namespace
{

/// True if `a` is older than `b`. Generations count up and may wrap.
bool is_older(std::uint32_t a, std::uint32_t b) noexcept
{
    return static_cast<std::int32_t>(a - b) < 0;
}

bool is_key_of(const ModelCounts& counts, ContentKey key) noexcept
{
    return key.kind == ContentKind::chunk        ? key.number < counts.chunks()
           : key.kind == ContentKind::index_page ? key.number < counts.index_pages()
                                                 : false;
}

} // namespace

ChunkLoader::ChunkLoader(Arena& arena, const PageSlots& slots, SlotQueues& queues, Log log,
                         const ChunkLoaderOptions& options)
    : slots_(slots)
    , queues_(queues)
    , bank_(arena, slots, queues)
    , log_(std::move(log))
    , open_(arena.take<OpenRequest>(options.open_requests))
    , batch_(arena.take<ContentKey>(options.open_requests))
    , forgotten_ns_(options.forgotten_ns)
{
    TACTUS_ASSERT(options.open_requests > 0);
}

void ChunkLoader::add(const ModelHeader& header, Linker& linker, ChunkLink& link, std::string name)
{
    TACTUS_ASSERT(linker.owner() == sides_.size());
    sides_.push_back(std::make_unique<Side>(*this, header, linker, link, std::move(name)));
    bank_.add(linker);
}

void ChunkLoader::step(std::int64_t now_ns)
{
    now_ns_ = now_ns;
    // The haptic thread frees a page before it requests the page again. The number of requests is
    // read first, so that the release that preceded each of them has been taken.
    const std::size_t requests = queues_.wanted.size();
    bank_.take_back_freed();
    take_requests(requests);
    for (const std::unique_ptr<Side>& side : sides_)
    {
        ask(*side);
        bring_base(*side);
        side->link.poll(*side);
        push_link_updates(*side);
    }
}

void ChunkLoader::take_requests(std::size_t count)
{
    PieceRequest request;
    for (std::size_t i = 0; i < count && queues_.wanted.try_pop(request); ++i)
    {
        open_request(request);
    }
}

void ChunkLoader::open_request(const PieceRequest& request)
{
    TACTUS_ASSERT(request.owner < sides_.size());
    Side& side = *sides_[request.owner];
    ++side.counters.requests;
    if (request.key.kind == ContentKind::base)
    {
        want_base(side, request);
        return;
    }
    TACTUS_ASSERT(is_key_of(side.counts, request.key));
    newest_generation_ =
        is_older(newest_generation_, request.generation) ? request.generation : newest_generation_;
    if (is_resident(side, request.key))
    {
        return; // The piece is already on its way to the haptic thread; the request is a duplicate.
    }
    if (OpenRequest* open = find_open(side, request.key); open != nullptr)
    {
        open->generation = request.generation;
        request_again(*open);
        return;
    }
    if (open_count_ == open_.size())
    {
        forget_oldest_generation();
    }
    open_[open_count_++] = {&side, request.key, request.generation, false, RequestClock(now_ns_)};
    ++side.unasked;
}

void ChunkLoader::forget_oldest_generation()
{
    std::size_t oldest = 0;
    for (std::size_t i = 1; i < open_count_; ++i)
    {
        oldest = is_older(open_[i].generation, open_[oldest].generation) ? i : oldest;
    }
    ++open_[oldest].side->counters.forgotten;
    remove(open_[oldest]);
}

/// Handles a request that the haptic thread repeats after its timeout (RequestList).
void ChunkLoader::request_again(OpenRequest& open)
{
    Side& side = *open.side;
    if (side.link.state() == LinkState::server_gone)
    {
        open.clock.wait_for_server(now_ns_);
    }
    else if (open.clock.request(now_ns_, forgotten_ns_))
    {
        ++side.counters.overdue;
        ++side.overdue;
        tell(side, open.key, "has not arrived; the surface there stays coarse");
    }
    ask_again(open);
}

void ChunkLoader::ask_again(OpenRequest& open)
{
    open.side->counters.asked_again += open.is_asked ? 1 : 0;
    open.side->unasked += open.is_asked ? 1 : 0;
    open.is_asked = false;
}

/// Sends the requests not yet sent to the model's link; all open ones if the server changed. The
/// link repeats lost requests. The haptic thread repeats those for pieces that were damaged or
/// found no free slot, which the link does not see.
void ChunkLoader::ask(Side& side)
{
    const std::span<OpenRequest> open = open_.first(open_count_);
    if (side.link.session() != side.session)
    {
        side.session = side.link.session();
        side.is_base_asked = false;
        for (OpenRequest& request : open)
        {
            if (request.side == &side)
            {
                request.clock.wait_for_server(now_ns_);
                ask_again(request);
            }
        }
    }
    if (side.unasked == 0 || side.link.state() == LinkState::server_gone)
    {
        return;
    }
    std::size_t count = 0;
    for (OpenRequest& request : open)
    {
        if (request.side == &side && !request.is_asked)
        {
            request.is_asked = true;
            batch_[count++] = request.key;
        }
    }
    side.unasked = 0;
    side.link.request(batch_.first(count), newest_generation_);
}

void ChunkLoader::receive(Side& side, ContentKey key, std::span<const std::byte> bytes)
{
    ++side.counters.pieces;
    side.counters.coded_bytes += bytes.size();
    if (side.base.receive(key, bytes))
    {
        side.base_progress_ns = now_ns_;
        if (side.base.missing() == 0 && side.base_cell)
        {
            adopt_base(side);
        }
        return;
    }
    const bool is_gone = !side.linker.has_base();
    if (is_gone || find_open(side, key) == nullptr)
    {
        close_request(side, key);
        ++side.counters.dropped_unasked;
        return;
    }
    if (key.kind == ContentKind::index_page)
    {
        adopt_index_page(side, {key.number}, bytes);
    }
    else
    {
        adopt_chunk(side, {key.number}, bytes);
    }
}

void ChunkLoader::want_base(Side& side, const PieceRequest& request)
{
    if (side.linker.has_base() || bank_.is_outdated(request.owner, request.generation))
    {
        return; // The mesh is already on its way to the haptic thread, or not wanted any more.
    }
    if (side.base.bytes().empty())
    {
        side.base = PartIntake(ContentKind::base, side.header.fields().base_bytes);
    }
    side.base_progress_ns = side.base_cell ? side.base_progress_ns : now_ns_;
    side.base_cell = request.key.number;
    side.is_base_asked = false;
}

void ChunkLoader::bring_base(Side& side)
{
    if (!side.base_cell)
    {
        return;
    }
    if (side.base.missing() == 0)
    {
        adopt_base(side);
    }
    else if (now_ns_ - side.base_progress_ns > forgotten_ns_)
    {
        ++side.counters.overdue;
        tell(side, {ContentKind::base, 0},
             "has not arrived; other models use its memory until then");
        give_cells_back(side);
    }
    else if (!side.is_base_asked && side.link.state() == LinkState::connected)
    {
        side.is_base_asked = true;
        std::vector<ContentKey> parts;
        side.base.list_missing(parts, parts_of(side.base.bytes().size()));
        side.link.request(parts, newest_generation_);
    }
}

/// Adopts a complete base mesh, as soon as no page linked to the previous mesh is resident. A
/// refused mesh returns its cells; otherwise a server that repeats it would occupy them
/// permanently.
void ChunkLoader::adopt_base(Side& side)
{
    if (side.linker.pages_here() > 0)
    {
        return;
    }
    const ContentKey key{ContentKind::base, 0};
    const std::vector<std::byte>& bytes = side.base.bytes();
    const BaseMesh mesh = slots_.base.part(*side.base_cell, side.counts);
    const bool is_true = content_hash(bytes) == side.header.fields().base_hash;
    const auto parsed = is_true ? parse_base_mesh(bytes, side.header, mesh)
                                : Result<Done, SpmRefusal>(SpmRefusal::wrong_identity);
    if (!parsed)
    {
        refuse(side, is_true ? side.counters.refused_content : side.counters.refused_hash, key,
               is_true ? refusal_text(parsed.error()) : "does not match its hash in the header");
        if (!is_true)
        {
            static_cast<void>(side.link.distrust(key));
        }
        side.base = {};
        give_cells_back(side);
        return;
    }
    side.linker.set_base(mesh);
    if (side.copies != nullptr)
    {
        side.copies->receive(key, bytes);
    }
    hand_over_cells(side, QueueEventKind::arrival);
    ++side.counters.delivered;
    side.base = {};
}

/// Returns the cells to the haptic thread, since other models may need them.
void ChunkLoader::give_cells_back(Side& side)
{
    bank_.expect_news_of(side.linker.owner());
    hand_over_cells(side, QueueEventKind::base_back);
}

void ChunkLoader::hand_over_cells(Side& side, QueueEventKind kind)
{
    const bool pushed = queues_.arrived.try_push({{ContentKind::base, 0},
                                                  *side.base_cell,
                                                  bank_.freed_taken(),
                                                  0,
                                                  kind,
                                                  static_cast<std::uint8_t>(side.linker.owner())});
    TACTUS_ASSERT(pushed);
    side.base_cell.reset();
}

void ChunkLoader::adopt_index_page(Side& side, IndexPageId page, std::span<const std::byte> bytes)
{
    const ContentKey key{ContentKind::index_page, page.value};
    if (content_hash(bytes) != side.header.index_entry(page).hash)
    {
        refuse(side, side.counters.refused_hash, key, "does not match its hash in the header");
        static_cast<void>(side.link.distrust(key));
        return;
    }
    if (bank_.free_index_pages() == 0)
    {
        ++side.counters.dropped_no_slot;
        close_request(side, key);
        return;
    }
    const std::uint32_t slot = bank_.next_index_page();
    if (auto done = parse_index_page(bytes, side.counts, page, slots_.index_pages[slot],
                                     bank_.entries(slot));
        !done)
    {
        refuse(side, side.counters.refused_content, key, refusal_text(done.error()));
        close_request(side, key); // The server has no other version.
        return;
    }
    bank_.take_index_page(side.linker.owner(), page);
    hand_over(side, key, slot, 0, bytes);
}

void ChunkLoader::adopt_chunk(Side& side, ChunkId chunk, std::span<const std::byte> bytes)
{
    const ContentKey key{ContentKind::chunk, chunk.value};
    const std::uint32_t index_slot =
        bank_.find_index_page(side.linker.owner(), {chunk.value >> kChunksPerIndexPageLog2});
    if (index_slot == IdTable::kAbsent)
    {
        ++side.counters.dropped_no_index;
        close_request(side, key);
        return;
    }
    const ChunkEntry& entry = bank_.entries(index_slot)[chunk.value % kChunksPerIndexPage];
    if (bytes.size() != entry.coded_bytes || content_hash(bytes) != entry.hash)
    {
        refuse(side, side.counters.refused_hash, key, "does not match its hash in the index page");
        static_cast<void>(side.link.distrust(key));
        return;
    }
    if (bank_.free_pages() == 0)
    {
        ++side.counters.dropped_no_slot;
        close_request(side, key);
        return;
    }
    const std::uint32_t slot = bank_.next_page();
    if (auto done = parse_chunk(bytes, side.header, chunk, slots_.pages[slot]); !done)
    {
        refuse(side, side.counters.refused_content, key, refusal_text(done.error()));
        close_request(side, key);
        return;
    }
    bank_.take_page(side.linker);
    side.linker.link_page(chunk, slot);
    hand_over(side, key, slot, side.linker.tell_linked(slot), bytes);
}

void ChunkLoader::hand_over(Side& side, ContentKey key, std::uint32_t slot, std::uint64_t linked,
                            std::span<const std::byte> bytes)
{
    if (side.copies != nullptr)
    {
        side.copies->receive(key, bytes);
    }
    const OpenRequest* open = find_open(side, key);
    TACTUS_ASSERT(open != nullptr);
    const std::int64_t waited_ns = open->clock.waited_ns(now_ns_);
    side.waiting_times.add(waited_ns);
    if (open->clock.is_overdue())
    {
        ++side.counters.overdue_came;
        tell(
            side, key,
            fmt::format("has arrived late, after {:.1f} s", 1e-9 * static_cast<double>(waited_ns)));
    }
    close_request(side, key);
    // Every arrival finds room: `arrived` holds as many arrivals as there are slots.
    const bool pushed =
        queues_.arrived.try_push({key, slot, bank_.freed_taken(), linked, QueueEventKind::arrival,
                                  static_cast<std::uint8_t>(side.linker.owner())});
    TACTUS_ASSERT(pushed);
    ++side.counters.delivered;
}

/// Pushes link updates after the arrivals, so that a record is reported after those it depends on.
void ChunkLoader::push_link_updates(Side& side)
{
    Linker::Update update;
    while (queues_.has_room_for_update() && side.linker.try_take_update(update))
    {
        const bool pushed =
            queues_.arrived.try_push({{ContentKind::chunk, update.chunk.value},
                                      update.slot,
                                      bank_.freed_taken(),
                                      update.linked,
                                      QueueEventKind::link_update,
                                      static_cast<std::uint8_t>(side.linker.owner())});
        TACTUS_ASSERT(pushed);
    }
}

void ChunkLoader::refuse(const Side& side, std::uint64_t& counter, ContentKey key,
                         const char* reason)
{
    ++counter;
    tell(side, key, reason, "; refused, nothing changed");
}

void ChunkLoader::tell(const Side& side, ContentKey key, std::string_view what,
                       std::string_view more)
{
    if (log_.try_begin())
    {
        log_.write_now(fmt::format("model '{}': {} {} {}{}", side.name,
                                   key.kind == ContentKind::chunk        ? "chunk"
                                   : key.kind == ContentKind::index_page ? "index page"
                                                                         : "base mesh",
                                   key.number, what, more));
    }
}

void ChunkLoader::add_requested_chunks(std::uint32_t model, std::vector<ChunkId>& chunks) const
{
    for (const OpenRequest& open : open_.first(open_count_))
    {
        if (open.side == sides_[model].get() && open.key.kind == ContentKind::chunk)
        {
            chunks.push_back({open.key.number});
        }
    }
}

bool ChunkLoader::is_starved(std::uint32_t model) const noexcept
{
    const Side* const side = sides_[model].get();
    return side->overdue > 0 &&
           std::ranges::any_of(
               open_.first(open_count_), [this, side](const OpenRequest& open)
               { return open.side == side && open.clock.is_missed(now_ns_, forgotten_ns_); });
}

ChunkLoader::OpenRequest* ChunkLoader::find_open(const Side& side, ContentKey key) noexcept
{
    const std::span<OpenRequest> open = open_.first(open_count_);
    const auto found =
        std::ranges::find_if(open, [&](const OpenRequest& request)
                             { return request.side == &side && request.key == key; });
    return found == open.end() ? nullptr : &*found;
}

void ChunkLoader::close_request(const Side& side, ContentKey key) noexcept
{
    if (OpenRequest* open = find_open(side, key); open != nullptr)
    {
        remove(*open);
    }
}

void ChunkLoader::remove(OpenRequest& open) noexcept
{
    open.side->unasked -= open.is_asked ? 0 : 1;
    open.side->overdue -= open.clock.is_overdue() ? 1U : 0U;
    open = open_[--open_count_];
}

bool ChunkLoader::is_resident(const Side& side, ContentKey key) const noexcept
{
    return key.kind == ContentKind::chunk
               ? side.linker.is_resident({key.number})
               : bank_.find_index_page(side.linker.owner(), {key.number}) != IdTable::kAbsent;
}

std::size_t ChunkLoader::required_bytes(std::size_t pages, std::size_t index_pages,
                                        const ChunkLoaderOptions& options) noexcept
{
    Arena arena = Arena::measuring();
    static_cast<void>(arena.take<OpenRequest>(options.open_requests));
    static_cast<void>(arena.take<ContentKey>(options.open_requests));
    return arena.used() + SlotBank::required_bytes(pages, index_pages);
}

} // namespace tactus
