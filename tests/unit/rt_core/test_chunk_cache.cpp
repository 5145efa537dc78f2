// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/chunk_cache.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <optional>
#include <set>

namespace tactus::test
{

namespace
{

/// Eight chunks in a row along x: chunk i's influence box is 100 i .. 100 i + 50 quanta in x and 0
/// .. 50 in y and z. The index page's box starts at -10, so its steps are of one quantum.
constexpr std::uint32_t kChunks = 8;
constexpr double kQuantum = 0x1p-10;

/// Sphere around a place on the row, in quanta.
RankedRegion sphere(double x, double radius, std::int64_t horizon_ns = 0)
{
    return {ModelId{0}, Vec3(x, 25.0, 25.0) * kQuantum, radius * kQuantum, horizon_ns};
}

/// Cache with its table and inbox; the test acts as the transport thread.
class CacheRig
{
public:
    /// Start of a second index page's row of chunks, in quanta.
    static constexpr std::int32_t kPageDistance = 100'000;

    CacheRig(std::uint32_t pages, std::uint32_t index_pages, std::uint32_t records,
             std::uint32_t models = 1)
        : parts_(sound_header(records))
    {
        for (std::size_t page = 0; page < parts_.entries.size(); ++page)
        {
            const auto start = static_cast<std::int32_t>(page) * kPageDistance;
            parts_.entries[page].box = {{start - 10, -10, -10}, {start + 900, 100, 100}};
        }
        bytes_ = parts_.write();
        const ModelHeader header = parsed(bytes_);
        slots_ = PageSlots::take(arena_, header.counts(), pages, index_pages);
        pool_.emplace(arena_, pages, index_pages, models);
        table_.emplace(pool_->pages, 0, slots_);
        sut.emplace(*pool_, ChunkCache::Kept{}, header, slots_, *table_, best_kernels());
        for (std::uint32_t slot = 0; slot < pages; ++slot)
        {
            free_pages_.push_back(slot);
        }
        for (std::uint32_t slot = 0; slot < index_pages; ++slot)
        {
            free_index_.push_back(slot);
        }
    }

    /// One frame; returns the requested pieces in order.
    std::vector<ContentKey> ask(std::initializer_list<RankedRegion> regions)
    {
        faults = FrameFault::none;
        WorkCounters of_frame;
        pool_->adopt_arrivals(budgets.pages, frame, of_frame);
        sut->request_missing({regions.begin(), regions.size()}, budgets, frame, of_frame, faults);
        work += of_frame;
        ++frame;
        collect_freed();
        std::vector<ContentKey> keys;
        PieceRequest request;
        while (pool_->queues.wanted.try_pop(request))
        {
            if (request.owner == table_->owner())
            {
                keys.push_back(request.key);
            }
        }
        return keys;
    }
    std::set<std::uint32_t> ask_chunks(std::initializer_list<RankedRegion> regions)
    {
        std::set<std::uint32_t> chunks;
        for (const ContentKey& key : ask(regions))
        {
            EXPECT_EQ(key.kind, ContentKind::chunk);
            EXPECT_TRUE(chunks.insert(key.number).second) << "asked twice";
        }
        return chunks;
    }

    void deliver_chunk(std::uint32_t chunk)
    {
        ASSERT_FALSE(free_pages_.empty()) << "more was asked for than there are slots";
        slot_of[chunk] = free_pages_.front();
        free_pages_.pop_front();
        ASSERT_TRUE(pool_->queues.arrived.try_push({{ContentKind::chunk, chunk}, slot_of[chunk]}));
    }
    /// One frame that requests the whole model.
    std::vector<ContentKey> fill()
    {
        ask({});
        sut->request_everything(budgets, work, faults);
        return ask({});
    }
    void deliver_index_page(std::uint32_t page)
    {
        ASSERT_FALSE(free_index_.empty());
        const std::uint32_t slot = free_index_.front();
        free_index_.pop_front();
        IndexPage& index = slots_.index_pages[slot];
        index.chunks = kChunks;
        for (std::uint16_t i = 0; i < kChunks; ++i)
        {
            const auto low = static_cast<std::uint16_t>(100 * i + 10);
            index.set_box(i, {{low, 10, 10}, {static_cast<std::uint16_t>(low + 50), 60, 60}});
        }
        ASSERT_TRUE(pool_->queues.arrived.try_push({{ContentKind::index_page, page}, slot}));
    }
    /// Requests and delivers until there are no further requests.
    void load(std::initializer_list<RankedRegion> regions)
    {
        for (auto keys = ask(regions); !keys.empty(); keys = ask(regions))
        {
            for (const ContentKey& key : keys)
            {
                key.kind == ContentKind::chunk ? deliver_chunk(key.number)
                                               : deliver_index_page(key.number);
            }
        }
    }
    [[nodiscard]] bool has(std::uint32_t chunk) const
    {
        return table_->find({chunk}) != IdTable::kAbsent;
    }
    PageTable& table() { return *table_; }
    CachePool& pool() { return *pool_; }
    /// Another model of the same pieces in the same pool, with all pages but `kept` available to
    /// others.
    struct Neighbour
    {
        Neighbour(CacheRig& rig, std::uint32_t owner, std::uint32_t kept)
            : table(rig.pool_->pages, owner, rig.slots_)
            , cache(*rig.pool_, {kept, 0}, parsed(rig.bytes_), rig.slots_, table, best_kernels())
        {
        }
        PageTable table;
        ChunkCache cache;
    };
    /// Delivers a piece of a model, possibly an unrequested one.
    void bring(ContentKey key, std::uint8_t owner)
    {
        auto& free = key.kind == ContentKind::chunk ? free_pages_ : free_index_;
        ASSERT_FALSE(free.empty());
        QueueEvent event{key, free.front()};
        event.owner = owner;
        free.pop_front();
        ASSERT_TRUE(pool_->queues.arrived.try_push(event));
    }
    [[nodiscard]] bool cache_was_full() const { return has_fault(faults, FrameFault::cache_full); }

private:
    void collect_freed()
    {
        FreedSlot freed;
        while (pool_->queues.freed.try_pop(freed))
        {
            (freed.kind == ContentKind::chunk ? free_pages_ : free_index_).push_back(freed.slot);
        }
    }

    HeaderParts parts_;
    std::vector<std::byte> bytes_;
    ArenaMemory memory_{1U << 22U};
    Arena arena_{memory_.bytes()};
    PageSlots slots_;
    std::optional<CachePool> pool_;
    std::optional<PageTable> table_;
    std::deque<std::uint32_t> free_pages_;
    std::deque<std::uint32_t> free_index_;

public:
    std::optional<ChunkCache> sut;
    Budgets budgets;
    WorkCounters work;
    FrameFault faults{FrameFault::none};
    std::uint32_t frame{ChunkCache::kFirstFrame};
    std::map<std::uint32_t, std::uint32_t> slot_of;
};

CacheRig one_index_page(std::uint32_t pages)
{
    return CacheRig(pages, 1, kChunks * 64);
}

using Chunks = std::set<std::uint32_t>;

} // namespace

TEST(ChunkCache, a_chunk_that_is_here_is_not_asked_for_again)
{
    CacheRig rig = one_index_page(kChunks);
    rig.load({sphere(25, 10)});

    EXPECT_TRUE(rig.has(0));
    EXPECT_TRUE(rig.ask({sphere(25, 10)}).empty());
    EXPECT_EQ(rig.sut->loads(), 1U);
    rig.sut->set_variant({.keeps_searches = false});
    EXPECT_TRUE(rig.ask({sphere(25, 10)}).empty());
    EXPECT_GT(rig.work.cache_hits, 0U);
}

TEST(ChunkCache, never_evicts_what_this_rounds_spheres_need_and_says_that_it_is_full)
{
    CacheRig rig = one_index_page(2);
    rig.load({sphere(75, 40)});
    ASSERT_TRUE(rig.has(0) && rig.has(1));
    ASSERT_FALSE(rig.cache_was_full());

    for (int i = 0; i < 20; ++i)
    {
        EXPECT_TRUE(rig.ask({sphere(125, 140)}).empty());
        EXPECT_TRUE(rig.cache_was_full());
    }

    EXPECT_TRUE(rig.has(0) && rig.has(1));
    EXPECT_EQ(rig.sut->evictions(), 0U);
}

TEST(ChunkCache, never_evicts_a_pinned_page)
{
    CacheRig rig = one_index_page(2);
    rig.load({sphere(75, 40)});
    rig.table().set_refined({0}, true);
    rig.table().set_refined({64 + 5}, true);

    for (int i = 0; i < 20; ++i)
    {
        EXPECT_TRUE(rig.ask({sphere(725, 10)}).empty());
        EXPECT_TRUE(rig.cache_was_full());
    }
    EXPECT_TRUE(rig.has(0) && rig.has(1));
    rig.table().set_refined({64 + 5}, false);

    EXPECT_EQ(rig.ask_chunks({sphere(725, 10)}), Chunks{7});
    EXPECT_TRUE(rig.has(0));
    EXPECT_FALSE(rig.has(1));
    EXPECT_FALSE(rig.cache_was_full());
}

TEST(ChunkCache, gives_back_the_least_recently_touched_page)
{
    CacheRig rig = one_index_page(2);
    rig.load({sphere(25, 10)});
    rig.load({sphere(225, 10)});
    ASSERT_TRUE(rig.has(0) && rig.has(2));
    for (int i = 0; i < 5; ++i)
    {
        rig.ask({sphere(25, 10)});
    }
    rig.ask({});
    rig.ask({});

    EXPECT_EQ(rig.ask_chunks({sphere(425, 10)}), Chunks{4});
    EXPECT_TRUE(rig.has(0));
    EXPECT_FALSE(rig.has(2));
    EXPECT_EQ(rig.work.evictions, 1U);
}

TEST(ChunkCache, what_is_only_predicted_never_evicts_what_is_of_use)
{
    CacheRig rig = one_index_page(2);
    rig.load({sphere(75, 40)});

    for (int i = 0; i < 20; ++i)
    {
        EXPECT_TRUE(rig.ask({sphere(75, 40), sphere(725, 10, 15'000'000)}).empty());
        EXPECT_FALSE(rig.cache_was_full()) << "a prediction that finds no room is no fault";
    }
    EXPECT_TRUE(rig.has(0) && rig.has(1));
}

TEST(ChunkCache, present_need_takes_the_place_of_what_was_only_predicted)
{
    CacheRig rig = one_index_page(2);
    rig.load({sphere(25, 10), sphere(725, 10, 15'000'000)});
    ASSERT_TRUE(rig.has(0) && rig.has(7));
    // Adoption counts as a use; after this many frames only the present counts.
    rig.frame += 2'000;

    Chunks asked;
    for (int i = 0; i < 4; ++i)
    {
        asked.merge(rig.ask_chunks({sphere(75, 40), sphere(725, 10, 15'000'000)}));
    }

    EXPECT_EQ(asked, Chunks{1});
    EXPECT_TRUE(rig.has(0));
    EXPECT_FALSE(rig.has(7));
}

TEST(ChunkCache, goes_on_asking_while_something_had_to_wait)
{
    CacheRig sut = one_index_page(8);
    sut.ask({sphere(400, 5'000)});
    sut.deliver_index_page(0);
    sut.budgets.requests = 1;
    for (std::uint32_t i = 0; i < kChunks; ++i)
    {
        sut.work = {};
        ASSERT_EQ(sut.ask_chunks({sphere(400, 5'000)}), Chunks{i});
    }
    EXPECT_TRUE(sut.ask({sphere(400, 5'000)}).empty());
}

TEST(ChunkCache, without_shortcuts_every_frame_is_searched)
{
    CacheRig sut = one_index_page(8);
    sut.sut->set_variant({.asks_near_models_only = false, .keeps_searches = false});
    sut.load({sphere(25, 10)});
    sut.work = {};
    for (int i = 0; i < 10; ++i)
    {
        sut.ask({sphere(25, 10)});
    }
    EXPECT_EQ(sut.work.regions_searched, 10U);
    EXPECT_EQ(sut.work.skipped.times(), (std::array<std::uint32_t, kSkips>{}));
}

TEST(ChunkCache, has_no_more_requests_under_way_for_a_whole_model_than_the_limit)
{
    constexpr std::uint32_t kPages = 4;
    constexpr std::uint32_t kAll = kPages * kChunksPerIndexPage;
    static_assert(kAll > kMaxFillingRequests + 1);
    CacheRig rig(kAll, kPages, kAll * kRecordsPerChunk);
    rig.budgets.requests = kAll;
    for (std::uint32_t page = 0; page < kPages; ++page)
    {
        rig.deliver_index_page(page);
    }
    std::vector<ContentKey> asked;
    for (std::uint32_t frame = 0; frame < kPages; ++frame)
    {
        const std::vector<ContentKey> more = rig.fill();
        asked.insert(asked.end(), more.begin(), more.end());
    }
    EXPECT_EQ(asked.size(), kMaxFillingRequests);
    EXPECT_TRUE(rig.fill().empty());

    rig.deliver_chunk(asked.front().number);
    EXPECT_EQ(rig.fill().size(), 1U) << "as soon as one is answered";
}

TEST(ChunkCache, has_no_more_requests_under_way_than_the_transport_side_remembers)
{
    constexpr std::uint32_t kPages = 40; // The sphere meets eight chunks of each.
    constexpr std::uint32_t kSlots = SlotQueues::kOpenRequests + 32;
    CacheRig rig(kSlots, kPages, kPages * kChunksPerIndexPage * kRecordsPerChunk);
    rig.budgets.requests = kSlots;
    for (std::uint32_t page = 0; page < kPages; ++page)
    {
        rig.deliver_index_page(page);
        rig.ask({}); // The page was prefetched before it is needed.
    }
    const RankedRegion everything = sphere(0, kPages * CacheRig::kPageDistance);
    const auto ask_for_long = [&]
    {
        Chunks asked;
        for (std::uint32_t frame = 0; frame < 2 * kPages; ++frame) // Each page has its turn.
        {
            asked.merge(rig.ask_chunks({everything}));
        }
        return asked;
    };
    const Chunks asked = ask_for_long();
    EXPECT_EQ(asked.size(), SlotQueues::kOpenRequests);
    EXPECT_TRUE(ask_for_long().empty());

    rig.deliver_chunk(*asked.begin());
    EXPECT_EQ(ask_for_long().size(), 1U) << "one is answered";
}

TEST(ChunkCache, takes_of_a_model_that_nobody_is_near_all_but_what_is_kept_for_it)
{
    for (const bool is_near : {false, true})
    {
        SCOPED_TRACE(is_near ? "somebody is near" : "nobody is near");
        CacheRig sut(4, 2, kChunks * kRecordsPerChunk, 2);
        CacheRig::Neighbour neighbour(sut, 1, 1);
        sut.deliver_index_page(0);
        for (std::uint32_t chunk = 0; chunk < 3; ++chunk)
        {
            sut.bring({ContentKind::chunk, chunk}, 1);
        }
        Chunks asked;
        for (int frame = 0; frame < 20; ++frame)
        {
            const Chunks more = sut.ask_chunks({sphere(400, 5'000)});
            asked.insert(more.begin(), more.end());
            for (std::uint32_t slot = 0; slot < 4 && is_near; ++slot)
            {
                if (neighbour.table.is_own(slot))
                {
                    neighbour.table.touch(slot, sut.frame);
                }
            }
            if (is_near)
            {
                neighbour.cache.request_missing(std::array{sphere(400, 5'000)}, sut.budgets,
                                                sut.frame, sut.work, sut.faults);
            }
        }
        EXPECT_EQ(asked.size(), is_near ? 1U : 3U) << "one slot was free";
        EXPECT_EQ(neighbour.table.used(), is_near ? 3U : 1U);
        EXPECT_TRUE(sut.cache_was_full());
    }
}

TEST(ChunkCache, in_a_large_pool_looks_at_some_pages_a_request_and_refuses_after_all_of_them)
{
    constexpr std::uint32_t kLooks = 128;
    constexpr std::uint32_t kPages = 3 * kLooks;
    constexpr std::uint32_t kIndexPages = kPages / kChunksPerIndexPage + 1;
    for (const bool is_one_free : {true, false})
    {
        CacheRig sut(kPages, kIndexPages, (kPages + 1) * kRecordsPerChunk);
        sut.budgets.pages = kMaxArrivalsPerFrame;
        for (std::uint32_t chunk = 0; chunk < kPages; ++chunk)
        {
            sut.deliver_chunk(chunk);
        }
        for (std::uint32_t page = 0; page < kIndexPages; ++page)
        {
            sut.deliver_index_page(page);
        }
        while (sut.sut->index_pages_used() < kIndexPages)
        {
            sut.ask({});
        }
        constexpr std::uint32_t kFree = kPages - 5; // One of the last pages in the search.
        for (std::uint32_t chunk = 0; chunk < kPages; ++chunk)
        {
            if (chunk != kFree || !is_one_free)
            {
                sut.table().set_refined({chunk * kRecordsPerChunk}, true);
            }
        }
        const double place = (kIndexPages - 1.0) * CacheRig::kPageDistance + 25;
        std::vector<std::size_t> asked;
        std::vector<bool> refused;
        for (int frame = 0; frame < 4; ++frame)
        {
            asked.push_back(sut.ask({sphere(place, 1)}).size());
            refused.push_back(sut.pool().refused_class() != kPriorityClasses);
        }
        EXPECT_EQ(asked, (std::vector<std::size_t>{0, 0, is_one_free ? 1U : 0U, 0}));
        EXPECT_EQ(refused, (std::vector<bool>{false, false, !is_one_free, !is_one_free}));
        EXPECT_EQ(sut.has(kFree), !is_one_free);
    }
}

TEST(ChunkCache, adopts_no_more_arrivals_in_a_frame_than_the_budget_and_the_limit)
{
    for (const std::uint32_t budget : {3U, 10 * kMaxArrivalsPerFrame})
    {
        CacheRig rig(kMaxArrivalsPerFrame + 1, 2, (kMaxArrivalsPerFrame + 1) * kRecordsPerChunk);
        rig.budgets.pages = budget;
        for (std::uint32_t chunk = 0; chunk <= kMaxArrivalsPerFrame; ++chunk)
        {
            rig.deliver_chunk(chunk);
        }
        const std::uint32_t most = std::min(budget, kMaxArrivalsPerFrame);

        rig.ask({});
        EXPECT_EQ(rig.table().used(), most);
        rig.ask({});
        EXPECT_EQ(rig.table().used(), std::min(2 * most, kMaxArrivalsPerFrame + 1));
    }
}

} // namespace tactus::test
