// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/replay_queues.hpp"

#include "platform/recording/recording.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/index_page.hpp"

#include <array>

namespace tactus
{

ReplayQueues::ReplayQueues(const Recording& recording, Frame& frame)
    : recording_(recording)
    , frame_(frame)
    , pages_(frame.pools().slots.pages.size())
    , index_pages_(frame.pools().slots.index_pages.size())
    , gives_cells_back_(recording.setup().models.size())
{
}

std::optional<std::string> ReplayQueues::open(const RecordedFrame& recorded)
{
    for (const QueueEvent& event : recorded.events)
    {
        if (Fault fault = replay(event))
        {
            return "model " + std::to_string(event.owner) + ": " + *fault;
        }
    }
    return grant_requests(recorded.request_room);
}

ReplayQueues::Fault ReplayQueues::replay(const QueueEvent& event)
{
    Fault fault = event.kind == QueueEventKind::arrival     ? arrive(event)
                  : event.kind == QueueEventKind::base_back ? give_back(event)
                                                            : update(event);
    if (!fault && !frame_.pools().cache.queues.arrived.try_push(event))
    {
        fault = "the queues have too little room";
    }
    return fault;
}

ReplayQueues::Fault ReplayQueues::arrive(const QueueEvent& event)
{
    if (Fault fault = take_back_freed(event.freed_taken))
    {
        return fault;
    }
    if (Fault fault = fill(event))
    {
        return fault;
    }
    if (event.key.kind == ContentKind::chunk &&
        frame_.model({event.owner}).linker.linked(event.slot) != event.linked)
    {
        return "different records of chunk " + std::to_string(event.key.number) + " are linked";
    }
    return std::nullopt;
}

ReplayQueues::Fault ReplayQueues::update(const QueueEvent& event)
{
    const Filled<ChunkId>& filled = pages_[event.slot];
    if (filled.id != ChunkId{event.key.number} || filled.model != event.owner ||
        frame_.model({event.owner}).linker.linked(event.slot) != event.linked)
    {
        return "different records of chunk " + std::to_string(event.key.number) +
               " are linked later";
    }
    return std::nullopt;
}

ReplayQueues::Fault ReplayQueues::give_back(const QueueEvent& event)
{
    Fault fault = take_back_freed(event.freed_taken);
    if (!fault && !has_cells_for(event))
    {
        fault = "cells are returned that were not lent";
    }
    gives_cells_back_[event.owner] = true;
    return fault;
}

/// True if the frame has lent the cells of this event for a base mesh. Cells that were given back
/// may be lent again only once the frame has acknowledged it.
bool ReplayQueues::has_cells_for(const QueueEvent& event) const
{
    const Model& model = frame_.model({event.owner});
    return model.awaits_base(event.slot) && !model.linker.has_base() &&
           !gives_cells_back_[event.owner];
}

/// Takes back freed slots up to the number `freed_taken`. Linking depends on the resident pages, so
/// a page is removed exactly where it was in the recording.
ReplayQueues::Fault ReplayQueues::take_back_freed(std::uint32_t freed_taken)
{
    for (; freed_taken_ != freed_taken; ++freed_taken_)
    {
        FreedSlot freed;
        if (!frame_.pools().cache.queues.freed.try_pop(freed))
        {
            return "fewer slots were returned";
        }
        if (freed.kind == ContentKind::base)
        {
            frame_.model({freed.slot}).linker.set_base({});
            gives_cells_back_[freed.slot] = false;
        }
        else if (freed.kind == ContentKind::chunk)
        {
            frame_.model({pages_[freed.slot].model}).linker.release_page(freed.slot);
            pages_[freed.slot] = {};
        }
        else
        {
            const Filled<IndexPageId>& filled = index_pages_[freed.slot];
            loaded_index_.erase({filled.model, filled.id.value});
            index_pages_[freed.slot] = {};
        }
    }
    return std::nullopt;
}

ReplayQueues::Fault ReplayQueues::fill(const QueueEvent& event)
{
    const std::uint32_t index = event.owner;
    Model& model = frame_.model({index});
    const std::uint32_t number = event.key.number;
    const std::uint32_t slot = event.slot;
    const std::span<const std::byte> bytes = recording_.piece(index, event.key);
    if (event.key.kind == ContentKind::base)
    {
        return bring_base(event);
    }
    if (!model.linker.has_base())
    {
        return "a piece arrives before the base mesh";
    }
    if (event.key.kind == ContentKind::chunk)
    {
        if (!pages_[slot].id.is_none() || model.linker.is_resident({number}))
        {
            return "slot " + std::to_string(slot) + " is in use, or chunk " +
                   std::to_string(number) + " is loaded already";
        }
        if (const auto done = parse_chunk(bytes, model.header, {number}, model.slots.pages[slot]);
            !done)
        {
            return "chunk " + std::to_string(number) + ": " + refusal_text(done.error());
        }
        model.linker.link_page({number}, slot);
        pages_[slot] = {ChunkId{number}, index};
        return std::nullopt;
    }
    if (!index_pages_[slot].id.is_none() || !loaded_index_.insert({index, number}).second)
    {
        return "index slot " + std::to_string(slot) + " is in use, or index page " +
               std::to_string(number) + " is loaded already";
    }
    std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    if (const auto done = parse_index_page(bytes, model.header.counts(), {number},
                                           model.slots.index_pages[slot], entries);
        !done)
    {
        return "index page " + std::to_string(number) + ": " + refusal_text(done.error());
    }
    index_pages_[slot] = {IndexPageId{number}, index};
    return std::nullopt;
}

/// Puts the base mesh into the cells that the frame lent for it, and nowhere else.
ReplayQueues::Fault ReplayQueues::bring_base(const QueueEvent& event)
{
    Model& model = frame_.model({event.owner});
    if (!has_cells_for(event) || model.linker.pages_here() > 0)
    {
        return "its base mesh arrives without a request";
    }
    const BaseMesh mesh = frame_.pools().slots.base.part(event.slot, model.header.counts());
    if (const auto done =
            parse_base_mesh(recording_.piece(event.owner, event.key), model.header, mesh);
        !done)
    {
        return std::string("its base mesh: ") + refusal_text(done.error());
    }
    model.linker.set_base(mesh);
    return std::nullopt;
}

/// Takes requests from the queue until it has as much room as in the recording.
ReplayQueues::Fault ReplayQueues::grant_requests(std::uint32_t request_room)
{
    SpscQueue<PieceRequest>& wanted = frame_.pools().cache.queues.wanted;
    PieceRequest request;
    const std::size_t capacity = wanted.capacity();
    while (capacity - wanted.size() < request_room && wanted.try_pop(request))
    {
    }
    return capacity - wanted.size() == request_room
               ? std::nullopt
               : Fault("the number of requests in the queues differs");
}

} // namespace tactus
