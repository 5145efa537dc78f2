// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_slots.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/served_model.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

namespace tactus::test
{

struct FreeDeleter
{
    void operator()(std::byte* bytes) const
    {
        std::free(bytes);
    } // NOLINT: aligned_alloc's partner.
};

/// Small model of a controller, and the haptic thread's side of the queues: its slots, checked at
/// every hand-over against the content of the model's pages.
struct QueueSide
{
    QueueSide(const TinyModel& model, std::uint32_t pages, std::uint32_t index_pages,
              std::uint32_t requests)
        : model_(model)
        , memory_(static_cast<std::byte*>(std::aligned_alloc(Arena::kAlignment, kBytes)))
        , arena({memory_.get(), kBytes})
        , header(parse_trusted_header(model.header).value())
        , slots(PageSlots::take(arena, model.counts, pages, index_pages))
        , link_pool(arena, pages)
        , linker(link_pool, 0, header, slots)
        , queues(arena, std::size_t{pages} + index_pages, requests)
    {
        const auto loaded = load_base_mesh(model.base, header, slots.base);
        EXPECT_TRUE(loaded.has_value());
    }

    [[nodiscard]] bool request(ContentKey key, std::uint32_t generation = 0)
    {
        return queues.wanted.try_push({key, generation});
    }

    /// Adopts all arrivals; returns their number.
    std::size_t adopt()
    {
        std::size_t adopted = 0;
        QueueEvent arrival;
        while (queues.arrived.try_pop(arrival))
        {
            if (arrival.kind == QueueEventKind::link_update)
            {
                update_linked(arrival);
                continue;
            }
            ++adopted;
            EXPECT_FALSE(owns(arrival.key)) << "piece " << arrival.key.number << " came twice";
            for (const auto& [key, slot] : owned_)
            {
                const bool is_same = (key.first == arrival.key.kind) && slot == arrival.slot;
                EXPECT_FALSE(is_same) << "slot " << slot << " is owned already";
            }
            owned_[{arrival.key.kind, arrival.key.number}] = arrival.slot;
            if (arrival.key.kind == ContentKind::chunk)
            {
                linked_[arrival.slot] = arrival.linked;
            }
            check_content(arrival, arrival.linked);
        }
        return adopted;
    }

    [[nodiscard]] bool owns(ContentKey key) const
    {
        return owned_.contains({key.kind, key.number});
    }
    [[nodiscard]] std::size_t owned(ContentKind kind) const
    {
        std::size_t count = 0;
        for (const auto& [key, slot] : owned_)
        {
            count += key.first == kind ? 1U : 0U;
        }
        return count;
    }
    [[nodiscard]] std::uint32_t slot_of(ContentKey key) const
    {
        return owned_.at({key.kind, key.number});
    }

    void give_back(ContentKey key)
    {
        const auto at = owned_.find({key.kind, key.number});
        ASSERT_NE(at, owned_.end());
        ASSERT_TRUE(queues.freed.try_push({key.kind, at->second}));
        owned_.erase(at);
    }

    /// Checks that every linked record has exactly the links of the whole model whose records and
    /// dependencies are linked.
    void check_links()
    {
        for (const auto& [key, slot] : owned_)
        {
            for (std::uint32_t place = 0; key.first == ContentKind::chunk && place < 64; ++place)
            {
                const std::size_t id = std::size_t{key.second} * 64 + place;
                for (std::uint32_t i = 0; i < kMaxStarFaces; ++i)
                {
                    if (!is_linked(static_cast<std::uint32_t>(id)) ||
                        model_.records[id].star[i].is_none())
                    {
                        continue;
                    }
                    const std::uint32_t expected = model_.records[id].next[i];
                    const std::uint32_t next = load_next(slots.pages[slot].records[place].next[i]);
                    const bool is_resident = expected == kNextExact || has_all_it_needs(expected);
                    EXPECT_TRUE(next == expected || (next == kNextPending && !is_resident))
                        << "record " << id << ", star face " << i << ": next " << next << ", not "
                        << expected;
                }
            }
        }
    }

    /// True if the queues have reported the record as linked.
    [[nodiscard]] bool is_linked(std::uint32_t record) const
    {
        const auto at = owned_.find({ContentKind::chunk, record / 64});
        return at != owned_.end() && ((linked_.at(at->second) >> (record % 64)) & 1U) != 0;
    }

private:
    static constexpr std::size_t kBytes = std::size_t{4} << 20U;

    [[nodiscard]] bool has_all_it_needs(std::uint32_t record) const
    {
        bool all = is_linked(record);
        for (const FaceState state : model_.records[record].before)
        {
            all = all && (state.is_base() || is_linked(state.record().value));
        }
        return all;
    }

    /// Checks records reported as linked against the model.
    void check_content(const QueueEvent& event, std::uint64_t linked) const
    {
        for (std::size_t place = 0; event.key.kind == ContentKind::chunk && place < 64; ++place)
        {
            const std::size_t id = std::size_t{event.key.number} * 64 + place;
            if (expects_sound_content && ((linked >> place) & 1U) != 0)
            {
                const VsplitRecord& got = slots.pages[event.slot].records[place];
                const VsplitRecord& expected = model_.records.at(id);
                EXPECT_EQ(got.star, expected.star) << "record " << id;
                EXPECT_EQ(got.before, expected.before) << "record " << id;
                EXPECT_EQ(got.position_m, expected.position_m) << "record " << id;
                EXPECT_EQ(got.parent, expected.parent) << "record " << id;
                EXPECT_EQ(got.error, expected.error) << "record " << id;
                EXPECT_EQ(got.bucket, expected.bucket) << "record " << id;
                EXPECT_EQ(got.depth, expected.depth) << "record " << id;
                EXPECT_EQ(got.reach, expected.reach) << "record " << id;
            }
        }
    }

    void update_linked(const QueueEvent& update)
    {
        EXPECT_EQ(update.key.kind, ContentKind::chunk);
        const auto at = owned_.find({ContentKind::chunk, update.key.number});
        if (at != owned_.end()) // Otherwise it was returned while the update was in transit.
        {
            EXPECT_EQ(at->second, update.slot);
            EXPECT_EQ(linked_[update.slot] & ~update.linked, 0U) << "a record is unlinked";
            check_content(update, update.linked & ~linked_[update.slot]);
            linked_[update.slot] = update.linked;
        }
    }

    const TinyModel& model_;
    std::unique_ptr<std::byte, FreeDeleter> memory_;
    std::map<std::uint32_t, std::uint64_t> linked_; ///< Linked records by slot.
    std::map<std::pair<ContentKind, std::uint32_t>, std::uint32_t> owned_;

public:
    bool expects_sound_content{true};
    Arena arena;
    ModelHeader header;
    PageSlots slots;
    LinkPool link_pool;
    Linker linker;
    SlotQueues queues;
};

} // namespace tactus::test
