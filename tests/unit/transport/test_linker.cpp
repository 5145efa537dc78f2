// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I12: a foreign id and a dependency cycle are always refused; which records are linked, wait or
/// are refused.

#include "host_tools/encode/record_coder.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/linker.hpp"
#include "tests/unit/transport/queue_side.hpp"
#include "tests/unit/transport/tiny_model.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace tactus
{
namespace
{

using test::make_tiny_model;
using test::QueueSide;
using test::TinyModel;

/// Parses and links chunks without a loader.
struct Bench
{
    explicit Bench(const TinyModel& tiny)
        : model(tiny), side(tiny, static_cast<std::uint32_t>(tiny.chunks.size()), 1, 1)
    {
    }

    void bring(std::uint32_t chunk, std::uint32_t slot)
    {
        bring_bytes(chunk, slot, model.chunks[chunk]);
    }
    /// Adds content that the model does not have, but parse accepts.
    void bring_forged(std::uint32_t chunk, std::uint32_t slot, std::span<const std::byte> bytes)
    {
        side.expects_sound_content = false;
        bring_bytes(chunk, slot, bytes);
    }
    void bring_bytes(std::uint32_t chunk, std::uint32_t slot, std::span<const std::byte> bytes)
    {
        ASSERT_TRUE(parse_chunk(bytes, side.header, {chunk}, side.slots.pages[slot]).has_value());
        side.linker.link_page({chunk}, slot);
        ASSERT_TRUE(side.queues.arrived.try_push(
            {{ContentKind::chunk, chunk}, slot, 0, side.linker.tell_linked(slot)}));
        for (Linker::Update update; side.linker.try_take_update(update);)
        {
            ASSERT_NE(update.chunk.value, chunk) << "was told with its arrival";
            ASSERT_TRUE(side.queues.arrived.try_push({{ContentKind::chunk, update.chunk.value},
                                                      update.slot,
                                                      0,
                                                      update.linked,
                                                      QueueEventKind::link_update}));
            side.adopt();
        }
        side.adopt();
    }
    void drop(std::uint32_t chunk)
    {
        const ContentKey key{ContentKind::chunk, chunk};
        side.linker.release_page(side.slot_of(key));
        side.give_back(key);
        FreedSlot freed;
        ASSERT_TRUE(side.queues.freed.try_pop(freed));
    }
    [[nodiscard]] std::size_t linked() const
    {
        std::size_t count = 0;
        for (std::uint32_t record = 0; record < model.records.size(); ++record)
        {
            count += side.is_linked(record) ? 1U : 0U;
        }
        return count;
    }

    const TinyModel& model;
    QueueSide side;
};

RC_GTEST_PROP(Linker, links_everything_in_any_order_of_arrival, (std::uint32_t seed, bool shuffled))
{
    const TinyModel model =
        make_tiny_model({.seed = seed, .records = 500, .shuffled_ids = shuffled});
    Bench bench(model);
    std::vector<std::uint32_t> order(model.chunks.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    for (std::uint32_t slot = 0; slot < order.size(); ++slot)
    {
        bench.bring(order[slot], slot);
        bench.side.check_links();
    }
    RC_ASSERT(bench.linked() == model.records.size());
    RC_ASSERT(bench.side.linker.records_refused() == 0U);
    RC_ASSERT(std::ranges::equal(bench.side.slots.base.next, model.base_next));
    for (std::uint32_t id = 0; id < model.records.size(); ++id)
    {
        const std::uint32_t slot = bench.side.slot_of({ContentKind::chunk, id / 64});
        RC_ASSERT(bench.side.slots.pages[slot].records[id % 64].next == model.records[id].next);
    }
}

RC_GTEST_PROP(Linker, a_page_that_returns_gets_all_its_links_back, (std::uint32_t seed))
{
    const TinyModel model = make_tiny_model({.seed = seed, .records = 400, .shuffled_ids = true});
    Bench bench(model);
    std::mt19937 random(seed);
    std::vector<std::uint32_t> free_slots;
    for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
    {
        bench.bring(chunk, chunk);
    }
    for (int round = 0; round < 6; ++round)
    {
        std::vector<std::uint32_t> gone;
        for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
        {
            if (random() % 2 == 0)
            {
                gone.push_back(chunk);
                free_slots.push_back(bench.side.slot_of({ContentKind::chunk, chunk}));
                bench.drop(chunk);
            }
        }
        bench.side.check_links();
        std::shuffle(gone.begin(), gone.end(), random);
        std::shuffle(free_slots.begin(), free_slots.end(), random);
        for (const std::uint32_t chunk : gone)
        {
            bench.bring(chunk, free_slots.back());
            free_slots.pop_back();
            bench.side.check_links();
        }
        RC_ASSERT(bench.linked() == model.records.size());
        RC_ASSERT(bench.side.linker.records_refused() == 0U);
    }
}

RC_GTEST_PROP(Linker, looks_at_a_record_once_for_each_that_it_names, (std::uint32_t seed))
{
    const TinyModel model =
        make_tiny_model({.seed = seed, .records = 1'000, .shuffled_ids = seed % 2 == 0});
    Bench bench(model);
    // The owners of its fan, its ring's vertices, and the creator of the anchor's face.
    std::uint64_t allowed = 0;
    for (const VsplitRecord& record : model.records)
    {
        allowed += 4U + 2U * record.fan_size;
    }
    // Last chunks first: nearly every record must wait.
    for (auto chunk = static_cast<std::uint32_t>(model.chunks.size()); chunk-- > 0;)
    {
        bench.bring(chunk, chunk);
    }
    RC_ASSERT(bench.linked() == model.records.size());
    RC_ASSERT(bench.side.linker.looks() <= allowed);
    RC_ASSERT(bench.side.linker.looks() > model.records.size()); // Some did wait.
}

TEST(Linker, records_wait_while_a_dependency_is_absent)
{
    const TinyModel model = make_tiny_model({.records = 130});
    Bench bench(model);
    bench.bring(1, 0);
    bench.bring(2, 1);
    for (std::uint32_t id = 64; id < 130; ++id)
    {
        bool depends_on_absent = false;
        for (std::uint32_t i = 0; i < model.records[id].fan_size; ++i)
        {
            const FaceState before = model.records[id].before[i];
            depends_on_absent |= !before.is_base() && before.record().value < 64;
        }
        EXPECT_FALSE(depends_on_absent && bench.side.is_linked(id)) << "record " << id;
    }
    EXPECT_EQ(bench.side.linker.records_refused(), 0U);
}

/// Chunk of a record with changed content.
std::vector<std::byte> forge(const TinyModel& model, std::uint32_t record, auto&& change)
{
    auto coded = model.coded;
    change(coded[record]);
    return model.chunk_of({record / 64}, coded);
}

/// First record whose anchor was last changed by another record.
std::uint32_t record_with_dependency(const TinyModel& model)
{
    for (std::uint32_t id = 0; id < 64; ++id)
    {
        if (model.coded[id].anchor.kind == CodedRecord::Owner::Kind::record)
        {
            return id;
        }
    }
    return 64;
}

void expect_refused(const TinyModel& model, std::uint32_t record, std::span<const std::byte> chunk)
{
    Bench bench(model);
    bench.bring_forged(0, 0, chunk);
    EXPECT_FALSE(bench.side.is_linked(record));
    EXPECT_GE(bench.side.linker.records_refused(), 1U);
}

TEST(Linker, refuses_an_anchor_that_the_owner_s_star_does_not_have)
{
    const TinyModel model = make_tiny_model({.records = 64});
    const std::uint32_t id = record_with_dependency(model);
    ASSERT_LT(id, 64U);
    expect_refused(model, id, forge(model, id, [](CodedRecord& coded) { coded.place = 7; }));
}

TEST(Linker, refuses_a_fan_that_has_no_next_face)
{
    const TinyModel model = make_tiny_model({.base_faces = 1, .records = 64});
    // One face in a base of one face: there is nothing beyond its edges.
    expect_refused(model, 0,
                   forge(model, 0,
                         [](CodedRecord& coded)
                         {
                             coded.right = 1;
                             coded.others[0] = {0, CodedRecord::Owner::Kind::base, {}};
                         }));
    expect_refused(model, 0, forge(model, 0, [](CodedRecord& coded) { coded.left = 1; }));
}

TEST(Linker, refuses_a_vertex_off_the_grid)
{
    const TinyModel model = make_tiny_model({.records = 64});
    for (const std::int32_t residual : {-2'000, 2'000})
    {
        expect_refused(model, 0,
                       forge(model, 0, [&](CodedRecord& coded) { coded.residual.fill(residual); }));
    }
}

TEST(Linker, refuses_a_place_that_another_record_has_taken)
{
    const TinyModel model = make_tiny_model({.base_faces = 1, .records = 64});
    // Record 0 splits base face 0; now another one claims the same.
    ASSERT_EQ(model.base_next[0], 0U);
    Bench bench(model);
    bench.bring_forged(0, 0, forge(model, 9, [&](CodedRecord& coded) { coded = model.coded[0]; }));
    EXPECT_TRUE(bench.side.is_linked(0));
    EXPECT_FALSE(bench.side.is_linked(9));
    EXPECT_GE(bench.side.linker.records_refused(), 1U);
    EXPECT_EQ(load_next(bench.side.slots.base.next[0]), 0U);
}

TEST(Linker, refuses_a_split_of_a_face_that_is_exact)
{
    const TinyModel model = make_tiny_model({.records = 64});
    const std::uint32_t id = record_with_dependency(model);
    const FaceState before = model.records[id].before[model.coded[id].left];
    expect_refused(model, id,
                   forge(model, before.record().value,
                         [&](CodedRecord& coded) { coded.error[before.place()] = 0; }));
}

TEST(Linker, refuses_a_record_deeper_than_the_header_states)
{
    const TinyModel model = make_tiny_model({.records = 64});
    const AllStars stars{model.records, model.rings};
    HeaderFields fields;
    fields.extent_quanta.fill(1'000);
    for (std::uint32_t id = 0; id < 64; ++id)
    {
        for (const std::uint32_t spare : {0U, 1U})
        {
            fields.max_depth = model.records[id].depth - 1U + spare;
            StarResolver<AllStars> sut(
                stars, model.counts, {model.base_positions_m, model.base_faces}, fields, 0x1p-20F);
            EXPECT_EQ(sut.resolve({id}, model.coded[id]) ==
                          StarResolver<AllStars>::Outcome::resolved,
                      spare == 1);
        }
    }
}

TEST(Linker, never_links_a_cycle_of_two_records)
{
    const TinyModel model = make_tiny_model({.records = 192});
    auto coded = model.coded;
    // Records 64 and 128 name each other as the last change of one of their faces.
    for (const auto& [id, other] : {std::pair{64U, 128U}, std::pair{128U, 64U}})
    {
        coded[id].left = coded[id].right = 0;
        coded[id].others = {};
        coded[id].anchor = {other, CodedRecord::Owner::Kind::record, {}};
        coded[id].place = 2;
        coded[id].sides = 3;
        coded[id].error = {20, 20, 20};
    }
    Bench bench(model);
    for (std::uint32_t chunk = 0; chunk < 3; ++chunk)
    {
        bench.bring_forged(chunk, chunk, model.chunk_of({chunk}, coded));
    }
    EXPECT_TRUE(bench.side.is_linked(0));
    EXPECT_FALSE(bench.side.is_linked(64));
    EXPECT_FALSE(bench.side.is_linked(128));
}

TEST(Linker, a_foreign_id_does_not_get_past_parse)
{
    const TinyModel model = make_tiny_model({.base_faces = 6, .records = 130});
    Bench bench(model);
    Page page;
    const auto parse = [&](auto&& change)
    { return parse_chunk(forge(model, 70, change), bench.side.header, {1}, page).has_value(); };
    const auto anchor_at = [&](std::uint32_t record)
    {
        return parse(
            [&](CodedRecord& c) {
                c.anchor = {record, CodedRecord::Owner::Kind::record, {}};
            });
    };
    EXPECT_TRUE(parse([](CodedRecord&) {}));
    EXPECT_TRUE(anchor_at(129));
    EXPECT_FALSE(anchor_at(130));
    EXPECT_FALSE(anchor_at(319)); // The last of its tier in a larger model.
    EXPECT_FALSE(anchor_at(70));  // Itself.
    EXPECT_FALSE(parse([](CodedRecord& c) { c.corner = 3; }));
    EXPECT_FALSE(parse([](CodedRecord& c) { c.left = c.right = 3; }));
    EXPECT_FALSE(parse([](CodedRecord& c) { c.residual[1] = 1 << 28; }));
    EXPECT_FALSE(parse([](CodedRecord& c) { c.anchor = {6, CodedRecord::Owner::Kind::base, {}}; }));
}

} // namespace
} // namespace tactus
