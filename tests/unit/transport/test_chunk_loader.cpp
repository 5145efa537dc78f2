// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/loopback_link.hpp"
#include "tests/unit/transport/queue_side.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace tactus
{
namespace
{

using test::make_tiny_model;
using test::QueueSide;
using test::TemporaryFolder;
using test::TinyModel;

constexpr ContentKey chunk_key(std::uint32_t number)
{
    return {ContentKind::chunk, number};
}
constexpr ContentKey index_key(std::uint32_t number)
{
    return {ContentKind::index_page, number};
}

constexpr ContentKey kBase{ContentKind::base, 0};
constexpr std::int64_t kStepNs = 1'000'000;

/// File, faulty link, loader, and the haptic thread's side of the queues.
struct Road
{
    explicit Road(const TinyModel& model, const LoopbackFaults& faults = {},
                  std::uint32_t pages = 16, std::uint32_t index_pages = 2,
                  const ChunkLoaderOptions& options = {})
        : store(ModelStore::open(folder.write("road.spm", model.file)).value(), {})
        , link(store, faults)
        , side(model, pages, index_pages, 64)
        , sut(
              side.arena, side.slots, side.queues,
              [this](const std::string& line) { lines.push_back(line); }, options)
    {
        sut.add(side.header, side.linker, link, "road");
    }

    void step()
    {
        now_ns += kStepNs;
        sut.step(now_ns);
    }
    /// Steps until the piece arrives, at most `steps` times.
    [[nodiscard]] bool comes(ContentKey key, int steps = 1)
    {
        for (int i = 0; i < steps && !side.owns(key); ++i)
        {
            step();
            side.adopt();
        }
        return side.owns(key);
    }

    void steps(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            step();
        }
    }
    /// Reports from the haptic thread that the base mesh is absent since a generation, and requests
    /// it.
    [[nodiscard]] bool request_base(std::uint32_t gone, std::uint32_t requested)
    {
        return side.queues.freed.try_push({ContentKind::base, 0, gone}) &&
               side.request(kBase, requested);
    }
    /// True if nothing passes the queues in `count` steps.
    [[nodiscard]] bool is_silent(int count)
    {
        QueueEvent event;
        for (int i = 0; i < count; ++i)
        {
            step();
            if (side.queues.arrived.try_pop(event))
            {
                return false;
            }
        }
        return true;
    }

    /// Steps with a repeated request, as of a cache that waits in vain.
    [[nodiscard]] bool comes_requested(ContentKey key, std::uint32_t generation)
    {
        for (int i = 0; i < 100 && !side.owns(key); ++i)
        {
            EXPECT_TRUE(side.request(key, generation));
            static_cast<void>(comes(key, 30));
        }
        return side.owns(key);
    }

    TemporaryFolder folder;
    StoreLink store;
    LoopbackLink link;
    QueueSide side;
    std::vector<std::string> lines;
    std::int64_t now_ns{0};
    ChunkLoader sut;
};

TEST(ChunkLoader, brings_an_index_page_and_then_its_chunks)
{
    const TinyModel model = make_tiny_model({.records = 300});
    Road road(model);
    ASSERT_TRUE(road.side.request(index_key(0)));
    ASSERT_TRUE(road.comes(index_key(0)));
    for (std::uint32_t chunk = 0; chunk < 5; ++chunk)
    {
        ASSERT_TRUE(road.side.request(chunk_key(chunk)));
    }
    road.step();
    EXPECT_EQ(road.side.adopt(), 5U);
    for (std::uint32_t record = 0; record < 300; ++record)
    {
        EXPECT_TRUE(road.side.is_linked(record)) << record;
    }
    EXPECT_EQ(road.sut.counters().delivered, 6U);
    EXPECT_EQ(road.sut.open_requests(), 0U);
    EXPECT_EQ(road.sut.free_pages(), 11U);
    EXPECT_TRUE(road.lines.empty());
}

TEST(ChunkLoader, brings_a_base_mesh_but_not_for_a_request_older_than_its_going)
{
    const TinyModel model = make_tiny_model({.records = 300});
    Road road(model);
    const std::vector<Vec3f> positions_m(road.side.slots.base.positions_m.begin(),
                                         road.side.slots.base.positions_m.end());
    ASSERT_TRUE(road.request_base(7, 6));
    EXPECT_TRUE(road.is_silent(10));
    EXPECT_FALSE(road.side.linker.has_base());

    std::ranges::fill(road.side.slots.base.positions_m, Vec3f{});
    ASSERT_TRUE(road.side.request(kBase, 7));
    road.steps(10);
    QueueEvent event;
    ASSERT_TRUE(road.side.queues.arrived.try_pop(event));
    EXPECT_EQ(event.key, kBase);
    EXPECT_TRUE(road.side.linker.has_base());
    EXPECT_TRUE(std::ranges::equal(road.side.slots.base.positions_m, positions_m));
    ASSERT_TRUE(road.side.request(kBase, 8)); // The base mesh is resident.
    EXPECT_TRUE(road.is_silent(1));
}

/// Base mesh of a lost server, and of a silent one.
TEST(ChunkLoader, gives_the_room_of_a_base_mesh_back_that_does_not_come_for_a_second)
{
    const TinyModel model = make_tiny_model({.base_faces = 12'000});
    for (const bool is_gone : {true, false})
    {
        SCOPED_TRACE(is_gone);
        Road road(model, {.loss = is_gone ? 0.0 : 1.0});
        QueueEvent event;
        ASSERT_TRUE(road.request_base(1, 1));
        if (is_gone)
        {
            road.link.lose_server();
        }
        road.step();
        const std::int64_t requested_ns = road.now_ns;
        while (!road.side.queues.arrived.try_pop(event))
        {
            ASSERT_LT(road.now_ns - requested_ns, 2'000'000'000);
            ASSERT_TRUE(road.side.request(kBase, 1)); // A further request changes nothing.
            road.step();
        }
        EXPECT_GT(road.now_ns - requested_ns, 1'000'000'000);
        EXPECT_EQ(event.kind, QueueEventKind::base_back);
        EXPECT_EQ(event.key, kBase);
        EXPECT_EQ(event.slot, 0U);
        EXPECT_EQ(road.sut.counters().overdue, 1U);
        EXPECT_FALSE(road.side.linker.has_base());
        EXPECT_NE(road.lines.at(0).find("base mesh 0 has not arrived"), std::string::npos)
            << road.lines.at(0);
        // A request reserves nothing until the haptic thread confirms, and older ones never do, for
        // any generation.
        road.link.lose_server();
        ASSERT_TRUE(road.side.request(kBase, 900));
        EXPECT_TRUE(road.is_silent(3'000));
        ASSERT_TRUE(road.request_base(1'000, 999));
        EXPECT_TRUE(road.is_silent(3'000));
    }
}

/// Otherwise a server that repeatedly sends a wrong mesh would block it permanently.
TEST(ChunkLoader, gives_the_room_of_a_base_mesh_back_that_it_refuses_and_asks_for_it_anew)
{
    const TinyModel model = make_tiny_model({.base_faces = 12'000});
    const std::uint32_t parts = parts_of(model.base.size());
    ASSERT_GE(parts, 3U);
    Road road(model, {.damage = 1.0});
    ASSERT_TRUE(road.side.queues.freed.try_push({ContentKind::base, 0, 1}));
    QueueEvent event;
    for (std::uint32_t time = 1; time <= 3; ++time)
    {
        ASSERT_TRUE(road.side.request(kBase, 1'000 * time));
        road.steps(10);
        ASSERT_TRUE(road.side.queues.arrived.try_pop(event)) << time;
        EXPECT_EQ(event.kind, QueueEventKind::base_back);
        EXPECT_EQ(road.sut.counters().refused_hash, time);
        EXPECT_EQ(road.sut.counters().pieces, std::uint64_t{time} * parts);
        ASSERT_TRUE(road.side.request(kBase, 1'000 * time + 1)); // Before the confirmation.
        EXPECT_TRUE(road.is_silent(1)) << time;
        ASSERT_TRUE(road.side.queues.freed.try_push({ContentKind::base, 0, 1'000 * time + 2}));
    }
    EXPECT_EQ(road.sut.counters().overdue, 0U);
    EXPECT_FALSE(road.side.linker.has_base());
}

/// The second server is asked for the rest only.
TEST(ChunkLoader, keeps_what_came_of_a_base_mesh_whose_room_was_given_back)
{
    const TinyModel model = make_tiny_model({.base_faces = 12'000});
    const std::uint32_t parts = parts_of(model.base.size());
    ASSERT_GE(parts, 3U);
    Road road(model, {.loss = 0.5});
    ASSERT_TRUE(road.request_base(1, 1));
    road.steps(5);
    const std::uint64_t before = road.sut.counters().pieces;
    ASSERT_GT(before, 0U);
    ASSERT_LT(before, parts);
    road.link.lose_server();
    QueueEvent event;
    while (!road.side.queues.arrived.try_pop(event))
    {
        road.step();
    }
    ASSERT_EQ(event.kind, QueueEventKind::base_back);
    ASSERT_TRUE(road.side.queues.freed.try_push({ContentKind::base, 0, 1'000}));
    road.link.regain_server();
    for (std::uint32_t generation = 1'000; !road.side.linker.has_base(); ++generation)
    {
        ASSERT_LT(generation, 1'200U);
        ASSERT_TRUE(road.side.request(kBase, generation));
        road.step();
    }
    EXPECT_EQ(road.sut.counters().pieces, parts);
    EXPECT_EQ(road.sut.counters().dropped_unasked, 0U);
}

TEST(ChunkLoader, counts_how_long_each_piece_was_waited_for)
{
    constexpr std::uint32_t kPolls = 7; // The link is polled once a step.
    const TinyModel model = make_tiny_model({.records = 300});
    LoopbackFaults faults;
    faults.delay_polls_min = kPolls;
    faults.delay_polls_max = kPolls;
    Road road(model, faults);
    ASSERT_TRUE(road.side.request(index_key(0)));
    ASSERT_TRUE(road.comes(index_key(0), 100));
    const std::int64_t once_ns = road.sut.waiting_times().sum_ns();
    EXPECT_EQ(once_ns, kPolls * kStepNs);
    ASSERT_TRUE(road.side.request(chunk_key(0)));
    ASSERT_TRUE(road.side.request(chunk_key(1)));
    ASSERT_TRUE(road.comes(chunk_key(1), 100));
    EXPECT_EQ(road.sut.counters().delivered, 3U);
    EXPECT_EQ(road.sut.waiting_times().sum_ns(), 3 * once_ns);
}

TEST(ChunkLoader, drops_a_chunk_whose_index_page_is_not_here)
{
    const TinyModel model = make_tiny_model({});
    Road road(model);
    ASSERT_TRUE(road.side.request(chunk_key(0)));
    EXPECT_FALSE(road.comes(chunk_key(0), 3));
    EXPECT_EQ(road.sut.counters().dropped_no_index, 1U);
    EXPECT_EQ(road.sut.free_pages(), 16U);
}

TEST(ChunkLoader, brings_a_piece_once_however_often_it_is_requested)
{
    const TinyModel model = make_tiny_model({});
    Road road(model, {.delay_polls_min = 3, .delay_polls_max = 3});
    for (int i = 0; i < 6; ++i)
    {
        ASSERT_TRUE(road.side.request(index_key(0)));
        road.step();
    }
    EXPECT_EQ(road.side.adopt(), 1U);
    EXPECT_EQ(road.sut.counters().delivered, 1U);
    EXPECT_EQ(road.sut.counters().asked_again, 3U) << "until it came";
    EXPECT_LE(road.sut.counters().dropped_unasked, 3U);
}

TEST(ChunkLoader, drops_what_finds_no_free_slot_and_brings_it_when_one_is_freed)
{
    const TinyModel model = make_tiny_model({.records = 200});
    Road road(model, {}, 2, 1);
    ASSERT_TRUE(road.side.request(index_key(0)));
    ASSERT_TRUE(road.comes(index_key(0)));
    for (const std::uint32_t chunk : {0U, 1U, 2U})
    {
        ASSERT_TRUE(road.side.request(chunk_key(chunk)));
    }
    EXPECT_FALSE(road.comes(chunk_key(2), 3));
    EXPECT_EQ(road.sut.counters().dropped_no_slot, 1U);
    EXPECT_EQ(road.side.owned(ContentKind::chunk), 2U);
    road.side.give_back(chunk_key(0));
    ASSERT_TRUE(road.side.request(chunk_key(2)));
    EXPECT_TRUE(road.comes(chunk_key(2)));
}

TEST(ChunkLoader, a_page_freed_and_requested_again_in_one_frame_comes_back)
{
    const TinyModel model = make_tiny_model({});
    Road road(model);
    for (const ContentKey key : {index_key(0), chunk_key(1)})
    {
        ASSERT_TRUE(road.side.request(key));
        ASSERT_TRUE(road.comes(key));
        road.side.give_back(key);
        ASSERT_TRUE(road.side.request(key));
        EXPECT_TRUE(road.comes(key));
    }
}

TEST(ChunkLoader, refuses_a_damaged_piece_with_nothing_changed_and_asks_when_requested_again)
{
    const TinyModel model = make_tiny_model({});
    Road road(model, {.damage = 1.0});
    ASSERT_TRUE(road.side.request(index_key(0)));
    EXPECT_FALSE(road.comes(index_key(0), 250));
    EXPECT_EQ(road.sut.counters().refused_hash, 1U);
    ASSERT_TRUE(road.side.request(index_key(0)));
    EXPECT_FALSE(road.comes(index_key(0), 250));
    EXPECT_EQ(road.sut.counters().refused_hash, 2U);
    EXPECT_EQ(road.sut.counters().asked_again, 1U);
    EXPECT_EQ(road.sut.free_index_pages(), 2U);
    ASSERT_FALSE(road.lines.empty());
    EXPECT_EQ(road.lines[0], "model 'road': index page 0 does not match its hash in the header; "
                             "refused, nothing changed");
}

TEST(ChunkLoader, brings_each_model_its_own_pieces_of_the_same_numbers)
{
    const TinyModel first = make_tiny_model({.seed = 1, .records = 64 * 2});
    const TinyModel second = make_tiny_model({.seed = 2, .records = 64 * 2});
    Road road(first, {}, 8, 2);
    QueueSide& side = road.side;
    const ModelHeader header = parse_trusted_header(second.header).value();
    const PageSlots slots = side.slots.of_model(side.arena, second.counts);
    ASSERT_TRUE(load_base_mesh(second.base, header, slots.base).has_value());
    Linker linker(side.link_pool, 1, header, slots);
    StoreLink store(ModelStore::open(road.folder.write("other.spm", second.file)).value(), {});
    road.sut.add(header, linker, store, "other");
    for (const ContentKey key : {index_key(0), chunk_key(0), chunk_key(1)})
    {
        for (const std::uint8_t owner : {std::uint8_t{0}, std::uint8_t{1}})
        {
            ASSERT_TRUE(side.queues.wanted.try_push({key, 0, owner}));
        }
        road.step();
    }
    std::array<std::uint32_t, 2> arrivals{};
    for (QueueEvent event; side.queues.arrived.try_pop(event);)
    {
        arrivals.at(event.owner) += event.kind == QueueEventKind::arrival ? 1U : 0U;
        const TinyModel& model = event.owner == 0 ? first : second;
        if (event.key.kind == ContentKind::chunk)
        {
            EXPECT_EQ(side.slots.pages[event.slot].records[0].position_m,
                      model.records[std::size_t{event.key.number} * 64].position_m);
        }
    }
    EXPECT_EQ(arrivals, (std::array<std::uint32_t, 2>{3, 3}));
    for (const std::uint32_t model : {0U, 1U})
    {
        SCOPED_TRACE(model);
        EXPECT_EQ(road.sut.counters(model).delivered, 3U);
        EXPECT_EQ(road.sut.counters(model).refused(), 0U);
        EXPECT_EQ(road.sut.waiting_times(model).total(), 3U);
    }
}

TEST(ChunkLoader, drops_what_nobody_asked_for)
{
    const TinyModel model = make_tiny_model({.records = 200});
    Road road(model);
    const std::vector<ContentKey> keys{index_key(0), chunk_key(0), {ContentKind::base, 0}};
    road.store.request(keys, 0);
    road.step();
    EXPECT_EQ(road.side.adopt(), 0U);
    EXPECT_EQ(road.sut.counters().dropped_unasked, 3U);
}

TEST(ChunkLoader, forgets_the_oldest_generation_when_too_much_is_requested)
{
    const TinyModel model = make_tiny_model({.records = 64 * 6});
    Road road(model, {.delay_polls_min = 1, .delay_polls_max = 1}, 16, 2, {.open_requests = 4});
    ASSERT_TRUE(road.side.request(index_key(0)));
    ASSERT_TRUE(road.comes(index_key(0), 2));
    for (std::uint32_t chunk = 0; chunk < 6; ++chunk)
    {
        ASSERT_TRUE(road.side.request(chunk_key(chunk), 10 + chunk));
    }
    EXPECT_TRUE(road.comes(chunk_key(5), 3));
    EXPECT_FALSE(road.side.owns(chunk_key(0)));
    EXPECT_FALSE(road.side.owns(chunk_key(1)));
    EXPECT_TRUE(road.side.owns(chunk_key(2)));
    EXPECT_EQ(road.sut.counters().forgotten, 2U);
}

TEST(ChunkLoader, has_no_clock_of_its_own_for_a_request_that_is_never_answered)
{
    const TinyModel model = make_tiny_model({});
    Road road(model, {.loss = 1.0});
    ASSERT_TRUE(road.side.request(index_key(0)));
    EXPECT_FALSE(road.comes(index_key(0), 10'000));
    EXPECT_EQ(road.sut.counters().asked_again, 0U);
    ASSERT_TRUE(road.side.request(index_key(0)));
    road.step();
    EXPECT_EQ(road.sut.counters().asked_again, 1U);
    EXPECT_EQ(road.sut.open_requests(), 1U);
    EXPECT_EQ(road.sut.counters().forgotten, 0U);
}

TEST(ChunkLoader, tells_which_chunks_are_requested)
{
    const TinyModel model = make_tiny_model({});
    Road road(model, {.loss = 1.0});
    std::vector<ChunkId> chunks;
    road.sut.add_requested_chunks(0, chunks);
    EXPECT_TRUE(chunks.empty());
    ASSERT_TRUE(road.side.request(index_key(0)));
    ASSERT_TRUE(road.side.request({ContentKind::chunk, 1}));
    road.step();
    ASSERT_EQ(road.sut.open_requests(), 2U);
    road.sut.add_requested_chunks(0, chunks);
    EXPECT_EQ(chunks, std::vector<ChunkId>{{1}});
}

/// Road with answers after 1.6 s, or `delay_ms`; requests are repeated as by a cache.
struct OverdueRoad : Road
{
    explicit OverdueRoad(const TinyModel& model, std::uint32_t delay_ms = 1'600)
        : Road(model, {.delay_polls_min = delay_ms, .delay_polls_max = delay_ms})
    {
    }

    void request_piece(int steps, int again = 250)
    {
        for (int i = 0; i < steps; ++i)
        {
            if (i % again == 0)
            {
                ASSERT_TRUE(side.request(index_key(0)));
            }
            step();
        }
    }
    [[nodiscard]] std::uint64_t overdue() const { return sut.counters().overdue; }
};

TEST(ChunkLoader, tells_once_of_a_piece_that_does_not_come_for_a_second_and_when_it_comes)
{
    const TinyModel model = make_tiny_model({});
    OverdueRoad road(model);
    road.request_piece(1'000);
    EXPECT_EQ(road.overdue(), 0U);
    EXPECT_TRUE(road.lines.empty());
    EXPECT_FALSE(road.sut.is_starved());
    road.request_piece(550);
    EXPECT_EQ(road.overdue(), 1U);
    EXPECT_TRUE(road.sut.is_starved());
    EXPECT_EQ(road.lines,
              std::vector<std::string>{
                  "model 'road': index page 0 has not arrived; the surface there stays coarse"});
    EXPECT_TRUE(road.comes(index_key(0), 100));
    EXPECT_FALSE(road.sut.is_starved());
    EXPECT_EQ(road.sut.counters().overdue_came, 1U);
    ASSERT_EQ(road.lines.size(), 2U);
    EXPECT_EQ(road.lines[1], "model 'road': index page 0 has arrived late, after 1.6 s");
}

TEST(ChunkLoader, is_not_starved_any_more_of_what_nobody_requests)
{
    const TinyModel model = make_tiny_model({});
    OverdueRoad road(model, 10'000);
    road.request_piece(1'300);
    ASSERT_TRUE(road.sut.is_starved());
    road.steps(800); // The request stays open.
    ASSERT_TRUE(road.sut.is_starved());
    road.steps(250);
    EXPECT_FALSE(road.sut.is_starved());
    EXPECT_EQ(road.sut.open_requests(), 1U);
}

TEST(ChunkLoader, misses_nothing_that_was_not_wanted_meanwhile_or_that_nobody_could_serve)
{
    const TinyModel model = make_tiny_model({});
    OverdueRoad forgotten(model);
    forgotten.request_piece(1'400, 1'200); // 1.2 s without a request.
    EXPECT_EQ(forgotten.overdue(), 0U);
    OverdueRoad without_server(model);
    without_server.request_piece(600);
    without_server.link.lose_server();
    without_server.request_piece(2'000);
    without_server.link.regain_server();
    without_server.request_piece(900);
    EXPECT_EQ(without_server.overdue(), 0U);
    without_server.request_piece(300);
    EXPECT_EQ(without_server.overdue(), 1U);
    EXPECT_EQ(without_server.sut.counters().overdue_came, 0U);
}

TEST(ChunkLoader, keeps_requests_while_the_server_is_gone_and_asks_the_next_one_at_once)
{
    const TinyModel model = make_tiny_model({});
    Road road(model, {.delay_polls_min = 1, .delay_polls_max = 1});
    ASSERT_TRUE(road.side.request(index_key(0)));
    road.step();
    road.link.lose_server();
    EXPECT_FALSE(road.comes(index_key(0), 10'000));
    EXPECT_EQ(road.sut.counters().asked_again, 0U);
    road.link.regain_server();
    EXPECT_TRUE(road.comes(index_key(0), 2));
}

/// Under any faults of the link, every request is finally satisfied, pages hold the file's content,
/// and no slot is lost or owned twice.
RC_GTEST_PROP(ChunkLoader, fulfils_every_request_over_a_bad_link_and_leaks_no_slot,
              (std::uint32_t seed))
{
    const TinyModel model =
        make_tiny_model({.seed = seed, .records = 64 * 10, .shuffled_ids = seed % 2 == 0});
    std::mt19937 random(seed);
    constexpr std::uint32_t pages = 6;
    constexpr std::uint32_t index_pages = 1;
    Road road(model,
              {.seed = seed,
               .loss = 0.2,
               .duplicates = 0.2,
               .damage = 0.1,
               .mix_ups = 0.1,
               .delay_polls_min = 0,
               .delay_polls_max = 12},
              pages, index_pages, {.open_requests = 8});
    ASSERT_TRUE(road.comes_requested(index_key(0), 0));
    for (int round = 0; round < 30; ++round)
    {
        const ContentKey wanted = chunk_key(static_cast<std::uint32_t>(random() % 10));
        if (road.side.owns(wanted))
        {
            continue;
        }
        if (road.side.owned(ContentKind::chunk) == pages)
        {
            std::uint32_t victim = 0;
            while (!road.side.owns(chunk_key(victim)))
            {
                ++victim;
            }
            road.side.give_back(chunk_key(victim));
        }
        ASSERT_TRUE(road.comes_requested(wanted, static_cast<std::uint32_t>(round)))
            << "chunk " << wanted.number;
        road.side.check_links();
    }
    road.step();
    ASSERT_EQ(road.sut.free_pages() + road.side.owned(ContentKind::chunk), pages);
    ASSERT_EQ(road.sut.open_requests(), 0U);
    ASSERT_EQ(road.side.linker.records_refused(), 0U);
}

/// The two threads of a controller, for the thread sanitizer and for faults that it cannot detect.
TEST(ChunkLoader, works_beside_a_haptic_thread)
{
    const TinyModel model = make_tiny_model({.records = 64 * 12, .shuffled_ids = true});
    Road road(model, {.delay_polls_min = 0, .delay_polls_max = 3}, 5, 1);
    std::atomic<bool> stop{false};
    std::thread transport(
        [&]
        {
            for (std::int64_t now_ns = 1; !stop.load(); now_ns += kStepNs)
            {
                road.sut.step(now_ns);
            }
        });
    std::mt19937 random(7);
    std::size_t adopted = 0;
    const auto make_room_for = [&](ContentKey key)
    {
        while (road.side.owned(ContentKind::chunk) >= 5 && !road.side.owns(key))
        {
            const ContentKey victim = chunk_key(static_cast<std::uint32_t>(random() % 12));
            if (road.side.owns(victim))
            {
                road.side.give_back(victim);
            }
        }
    };
    const auto bring = [&](ContentKey key)
    {
        while (!road.side.owns(key))
        {
            // A request still in transit when its chunk was returned loads that again, which takes
            // the place.
            make_room_for(key);
            // Requests may be dropped on purpose (no slot, no index): the cache repeats them.
            static_cast<void>(road.side.request(key));
            std::this_thread::yield();
            adopted += road.side.adopt();
        }
    };
    bring(index_key(0));
    while (adopted < 150)
    {
        bring(chunk_key(static_cast<std::uint32_t>(random() % 12)));
        road.side.check_links();
        if (adopted % 20 == 0 && road.side.owns(index_key(0)))
        {
            road.side.give_back(index_key(0));
            bring(index_key(0));
        }
    }
    stop = true;
    transport.join();
    EXPECT_EQ(road.sut.counters().refused(), 0U);
}

} // namespace
} // namespace tactus
