// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/replay_door.hpp"

#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/index_page.hpp"

#include <array>

namespace tactus
{

ReplayDoor::ReplayDoor(const Recording& recording, std::uint32_t index, Model& model)
    : recording_(recording)
    , index_(index)
    , model_(model)
    , pages_(model.slots.pages.size())
    , index_pages_(model.slots.index_pages.size())
{
}

std::optional<std::string> ReplayDoor::open(const RecordedFrame::Door& door)
{
    for (const DoorEvent& event : door.events)
    {
        Fault fault = event.kind == DoorEventKind::arrival ? arrive(event) : update(event);
        if (!fault && !model_.inbox.arrived.try_push(event))
        {
            fault = "more waits at the door than it has room for";
        }
        if (fault)
        {
            return fault;
        }
    }
    return grant_wishes(door.wish_room);
}

ReplayDoor::Fault ReplayDoor::arrive(const DoorEvent& event)
{
    if (Fault fault = take_back_freed(event.freed_taken))
    {
        return fault;
    }
    if (Fault fault = fill(event))
    {
        return fault;
    }
    if (event.key.kind == ContentKind::chunk && model_.linker.linked(event.slot) != event.linked)
    {
        return "other records of chunk " + std::to_string(event.key.number) + " are linked";
    }
    return std::nullopt;
}

ReplayDoor::Fault ReplayDoor::update(const DoorEvent& event)
{
    if (pages_[event.slot] != ChunkId{event.key.number} ||
        model_.linker.linked(event.slot) != event.linked)
    {
        return "other records of chunk " + std::to_string(event.key.number) + " are linked later";
    }
    return std::nullopt;
}

/// Linking looks at every page that is here, so a page goes exactly when it went in the recording.
ReplayDoor::Fault ReplayDoor::take_back_freed(std::uint32_t freed_taken)
{
    for (; freed_taken_ != freed_taken; ++freed_taken_)
    {
        ChunkInbox::Freed freed;
        if (!model_.inbox.freed.try_pop(freed))
        {
            return "fewer slots were given back";
        }
        if (freed.kind == ContentKind::chunk)
        {
            model_.linker.release_page(freed.slot);
            pages_[freed.slot] = {};
        }
        else
        {
            loaded_index_.erase(index_pages_[freed.slot].value);
            index_pages_[freed.slot] = {};
        }
    }
    return std::nullopt;
}

ReplayDoor::Fault ReplayDoor::fill(const DoorEvent& event)
{
    const std::uint32_t number = event.key.number;
    const std::uint32_t slot = event.slot;
    const std::span<const std::byte> bytes = recording_.piece(index_, event.key);
    if (event.key.kind == ContentKind::chunk)
    {
        if (!pages_[slot].is_none() || model_.linker.is_resident({number}))
        {
            return "slot " + std::to_string(slot) + " is in use, or chunk " +
                   std::to_string(number) + " is here already";
        }
        if (const auto done = parse_chunk(bytes, model_.header, {number}, model_.slots.pages[slot]);
            !done)
        {
            return "chunk " + std::to_string(number) + ": " + refusal_text(done.error());
        }
        model_.linker.link_page({number}, slot);
        pages_[slot] = {number};
        return std::nullopt;
    }
    if (!index_pages_[slot].is_none() || !loaded_index_.insert(number).second)
    {
        return "index slot " + std::to_string(slot) + " is in use, or index page " +
               std::to_string(number) + " is here already";
    }
    std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    if (const auto done = parse_index_page(bytes, model_.header.counts(), {number},
                                           model_.slots.index_pages[slot], entries);
        !done)
    {
        return "index page " + std::to_string(number) + ": " + refusal_text(done.error());
    }
    index_pages_[slot] = {number};
    return std::nullopt;
}

/// Takes wishes away until there is as much room for more as there was.
ReplayDoor::Fault ReplayDoor::grant_wishes(std::uint32_t wish_room)
{
    ChunkInbox::Wish wish;
    const std::size_t capacity = model_.inbox.wanted.capacity();
    while (capacity - model_.inbox.wanted.size() < wish_room && model_.inbox.wanted.try_pop(wish))
    {
    }
    return capacity - model_.inbox.wanted.size() == wish_room
               ? std::nullopt
               : Fault("another number of wishes waits at the door");
}

} // namespace tactus
