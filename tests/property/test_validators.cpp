// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The validators detect every kind of damage: each is planted in a model after some touches,
/// reported by name, and repaired.

#include "rt_core/abtree/validate_tree.hpp"
#include "rt_core/cache/validate_cache.hpp"
#include "rt_core/forest/validate_forest.hpp"
#include "rt_core/frame/validate_model.hpp"
#include "rt_core/spm/validate_pages.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/loaded_forest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <string>
#include <utility>

namespace tactus::test
{
namespace
{

/// Model after a settled touch: in the middle of the hierarchy, with pages left to load.
class Validators : public testing::Test
{
protected:
    Validators()
    {
        place_ = to_vec3(model_.faces[model_.faces.size() / 2][0]);
        rig_.settle(place_, {}, 400);
    }

    [[nodiscard]] Model& sut() { return rig_.model(); }
    [[nodiscard]] std::string flaw() { return text_of(find_flaw(sut())).data(); }

    /// Writes a wrong value to a place that the validators read, and expects their words.
    template <typename T>
    void expect_flaw(const T& place, const T& wrong, const std::string& words)
    {
        ASSERT_EQ(flaw(), "");
        auto& writable = const_cast<T&>(place); // NOLINT: the memory under it is the arena's.
        const T right = std::exchange(writable, wrong);
        EXPECT_NE(flaw().find(words), std::string::npos)
            << "wanted: " << words << "\nsaid: " << flaw();
        writable = right;
        ASSERT_EQ(flaw(), "");
    }

    /// First number for which a condition holds.
    template <typename Condition>
    [[nodiscard]] static std::uint32_t first(const Condition& holds, std::uint32_t from = 0)
    {
        while (!holds(from))
        {
            ++from;
        }
        return from;
    }
    [[nodiscard]] std::uint32_t some_block(bool in_use, std::uint32_t from = 0)
    {
        return first([&](std::uint32_t i) { return sut().tree.is_block_in_use(i) == in_use; },
                     from);
    }
    [[nodiscard]] std::uint32_t some_node(bool in_use)
    {
        return first(
            [&](std::uint32_t i) {
                return sut().tree.node(i).in_use == in_use &&
                       sut().tree.root() != TreeRef::to_node(i);
            });
    }
    [[nodiscard]] std::uint32_t first_lane(std::uint32_t block)
    {
        return static_cast<std::uint32_t>(
            std::countr_zero(std::uint32_t{sut().tree.block(block).faces}));
    }
    /// Slot with a page that has a refined record.
    [[nodiscard]] std::uint32_t pinned_slot()
    {
        return first([&](std::uint32_t i) { return sut().pages.meta(i).refined != 0; });
    }
    /// Slot with a page that has none, other than this one.
    [[nodiscard]] std::uint32_t unpinned_slot(ChunkId other = {})
    {
        return first(
            [&](std::uint32_t i)
            {
                const PageTable::Meta& meta = sut().pages.meta(i);
                return !meta.chunk.is_none() && meta.chunk != other && meta.refined == 0;
            });
    }
    [[nodiscard]] std::uint32_t empty_slot()
    {
        return first([&](std::uint32_t i) { return sut().pages.meta(i).chunk.is_none(); });
    }
    /// Record that is linked but not refined.
    [[nodiscard]] RecordId unsplit_record()
    {
        return {first(
            [&](std::uint32_t i)
            { return !sut().pages.is_refined({i}) && sut().pages.find_linked({i}) != nullptr; })};
    }
    /// Active face that some record has changed.
    [[nodiscard]] const VertexForest::ActiveFace& changed_face()
    {
        return sut().forest.face({first(
            [&](std::uint32_t i)
            {
                const VertexForest::ActiveFace& face = sut().forest.face({i});
                return !face.id.is_none() && !face.state.is_base();
            })});
    }

    const TestModel& model_ = small_model(0);
    FrameRig rig_{model_, {}};
    Vec3 place_{0.0, 0.0, 0.0};
};

template <typename T>
T flipped(T value, unsigned bit)
{
    return static_cast<T>(value ^ (T{1} << bit));
}

} // namespace

TEST_F(Validators, a_touched_model_is_sound)
{
    EXPECT_EQ(flaw(), "");
    EXPECT_GT(sut().forest.refined_records(), 0U);
    EXPECT_GT(sut().tree.nodes_used(), 1U);
    EXPECT_LT(sut().pages.used(), sut().pages.capacity());
}

TEST_F(Validators, a_flaw_is_one_line_that_is_never_too_long)
{
    EXPECT_STREQ(text_of({}).data(), "");
    EXPECT_STREQ(text_of({"block", 0, "is empty"}).data(), "block 0 is empty");
    EXPECT_STREQ(text_of({"node", 4'294'967'295U, "waits"}).data(), "node 4294967295 waits");
    const std::string long_words(500, 'x');
    EXPECT_EQ(std::string(text_of({"prim", 1, long_words.c_str()}).data()).size(), 127U);
}

TEST_F(Validators, a_model_that_must_be_sound_ends_the_program_with_the_flaw)
{
    require_sound(sut());
    EXPECT_DEATH(
        {
            set_assert_handler([](const char* words, const char*, int) noexcept
                               { static_cast<void>(std::fputs(words, stderr)); });
            const_cast<BlockSide&>(sut().tree.side(some_block(true))).in_use = false; // NOLINT
            require_sound(sut());
        },
        "blocks are in use, but others are neither in use nor free");
}

TEST_F(Validators, a_rig_that_validates_ends_with_model_and_frame)
{
    // The death test is a separate process, which removes its models when it ends.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            FrameRig::validate_every(1);
            const_cast<BlockSide&>(sut().tree.side(some_block(true))).in_use = false; // NOLINT
            rig_.step(place_);
        },
        testing::ExitedWithCode(2),
        "frame rig: frame [0-9]+, model .*: tree .*neither in use nor free");
}

TEST_F(Validators, blocks_that_leak_or_are_lost_are_told)
{
    const AbTree& tree = sut().tree;
    const std::uint32_t used = some_block(true);
    const std::uint32_t free = some_block(false);
    expect_flaw(tree.side(used).in_use, false, "blocks are in use, but others are neither");
    expect_flaw(tree.side(free).in_use, true, "is in use and free");
    expect_flaw(tree.side(free).parent, free, "is in a free list that is too long");
    expect_flaw(tree.side(free).parent, used, "is in use and free");
    expect_flaw(tree.side(free).parent, kNoNode, "free list, but the pool's count differs");
    expect_flaw(tree.side(free).parent, 1'000'000U, "is free and out of range");
}

TEST_F(Validators, links_between_blocks_and_nodes_that_differ_are_told)
{
    const AbTree& tree = sut().tree;
    const std::uint32_t block = some_block(true);
    const std::uint32_t node = some_node(true);
    expect_flaw(tree.side(block).parent, kNoNode, "is not linked from its parent");
    expect_flaw(tree.side(block).child, flipped(tree.side(block).child, 0),
                "is not linked from its parent");
    expect_flaw(tree.side(block).is_marked, true, "is marked after refit");
    expect_flaw(tree.node(node).parent, kNoNode, "has a child that is linked elsewhere");
    expect_flaw(tree.node(node).is_queued, true, "is marked after refit");
    expect_flaw(tree.node(node).in_use, false, "nodes are in use, but others are neither");
    expect_flaw(tree.node(some_node(false)).in_use, true, "is in use and free");
    const auto first = static_cast<std::uint32_t>(std::countr_zero(tree.node(node).mask));
    expect_flaw(tree.node(node).children[first], TreeRef{}, "is not linked from its parent");
}

TEST_F(Validators, nodes_that_contradict_themselves_are_told)
{
    const AbNode& node = sut().tree.node(some_node(true));
    const auto first = static_cast<std::uint32_t>(std::countr_zero(node.mask));
    const std::uint32_t digit = node.range_of(first).first;
    expect_flaw(node.shift, static_cast<std::uint8_t>(node.shift + 1), "lies off its path");
    const std::string wrong_bits = "has a wrong coarse or exact bit at its parent";
    expect_flaw(node.coarse, flipped(node.coarse, first), wrong_bits);
    expect_flaw(node.exact, flipped(node.exact, first), wrong_bits);
    expect_flaw(node.digit_map, node.digit_map ^ (1U << (4 * digit)), "lies off its path");
    expect_flaw(node.prefix, ~node.prefix, "lies off its path");
    expect_flaw(node.mask, flipped(node.mask, first), "is not linked from its parent");
}

TEST_F(Validators, boxes_that_are_not_their_faces_are_told)
{
    const AbTree& tree = sut().tree;
    const std::uint32_t block = some_block(true);
    const AbNode& parent = tree.node(tree.side(block).parent);
    const std::size_t child = tree.side(block).child;
    expect_flaw(parent.volumes.low[0][child], parent.volumes.low[0][child] + 1.0F,
                "has another box at its parent");
    expect_flaw(parent.volumes.high[2][child], parent.volumes.high[2][child] + 1.0F,
                "has another box at its parent");
    for (const std::uint8_t AbNode::*const bits : {&AbNode::coarse, &AbNode::exact})
    {
        expect_flaw(parent.*bits, flipped(parent.*bits, static_cast<unsigned>(child)),
                    "has a wrong coarse or exact bit at its parent");
    }
    expect_flaw(tree.block(block).vertices, std::uint16_t{0},
                "has a box that does not hold a face");
}

TEST_F(Validators, faces_in_a_wrong_lane_are_told)
{
    const AbTree& tree = sut().tree;
    const std::uint32_t block = some_block(true);
    const std::uint32_t lane = first_lane(block);
    const std::uint32_t other = some_block(true, block + 1);
    expect_flaw(tree.block(block).faces, std::uint16_t{0}, "is in use and empty");
    expect_flaw(tree.side(block).prims[lane], PrimId{}, "holds a prim that does not exist");
    expect_flaw(tree.side(block).prims[lane], tree.side(other).prims[first_lane(other)],
                "names another lane");
    std::uint32_t partly = block; // The last lane is free.
    while (std::popcount(tree.block(partly).faces) == kBlockFaces)
    {
        partly = some_block(true, partly + 1);
    }
    expect_flaw(tree.side(partly).coarse, flipped(tree.side(partly).coarse, kBlockFaces - 1),
                "has wrong coarse bits");
    expect_flaw(tree.block(block).corners[1][lane], std::uint8_t{16},
                "has a face without a vertex");
}

TEST_F(Validators, pages_whose_bits_contradict_are_told)
{
    const std::uint32_t pinned = pinned_slot();
    const PageTable::Meta& meta = sut().pages.meta(pinned);
    const PageTable::Meta& empty = sut().pages.meta(empty_slot());
    expect_flaw(empty.linked, std::uint64_t{1}, "has records and no page");
    expect_flaw(empty.chunk, meta.chunk, "has a page that is not found in this slot");
    expect_flaw(meta.chunk, ChunkId{}, "has records and no page");
    expect_flaw(meta.chunk, ChunkId{sut().header.counts().chunks()},
                "has a chunk that the model does not have");
    expect_flaw(meta.linked, std::uint64_t{0}, "has a refined record that is not linked");
    expect_flaw(meta.held, ~meta.refined, "holds a record that is not refined");
    expect_flaw(meta.refined, std::uint64_t{0}, "was split before one that it depends on");
}

TEST_F(Validators, a_table_whose_index_has_other_pages_is_told)
{
    const std::uint32_t unpinned = unpinned_slot();
    const PageTable::Meta& meta = sut().pages.meta(unpinned);
    expect_flaw(meta, PageTable::Meta{}, "pages are in its slots, but its index differs");
    // The cache is not notified.
    const PageTable::Meta before = meta;
    sut().pages.evict(unpinned);
    EXPECT_NE(flaw().find("slots are used, but the pool's count differs"), std::string::npos)
        << flaw();
    sut().pages.adopt(before.chunk, unpinned, before.touched, before.linked);
    EXPECT_EQ(flaw(), "");
}

TEST_F(Validators, what_is_requested_and_here_is_told)
{
    // The tool is far away, without a delivery.
    const Vec3 elsewhere = to_vec3(model_.faces[0][0]);
    rig_.step_without_delivery({elsewhere}, {}, {});
    PieceRequest request;
    while (rig_.frame().pools().cache.queues.wanted.try_pop(request) &&
           request.key.kind != ContentKind::chunk)
    {
    }
    ASSERT_EQ(request.key.kind, ContentKind::chunk);
    ASSERT_EQ(flaw(), "");
    sut().pages.adopt({request.key.number}, empty_slot(), ChunkCache::kFirstFrame);
    // The slot's end also reduces the count of those at the transport; evicting another restores
    // it.
    sut().pages.evict(unpinned_slot({request.key.number}));
    EXPECT_EQ(flaw(), "chunk " + std::to_string(request.key.number) + " is requested and resident");
}

TEST_F(Validators, index_pages_of_a_wrong_size_are_told)
{
    for (const IndexPage& page : sut().slots.index_pages)
    {
        if (page.chunks != 0)
        {
            expect_flaw(page.chunks, page.chunks + 1, "has too few or too many chunks");
            return;
        }
    }
    FAIL() << "no index page is here";
}

TEST_F(Validators, slots_that_go_back_twice_are_told)
{
    while (rig_.frame().pools().cache.queues.freed.try_push({ContentKind::chunk, 0}))
    {
    }
    EXPECT_NE(flaw().find("slots are on their way back, more than there are free slots"),
              std::string::npos)
        << flaw();
}

TEST_F(Validators, faces_of_the_forest_that_contradict_their_records_are_told)
{
    const VertexForest::ActiveFace& face = changed_face();
    const VertexId other{face.corners[0] == VertexId{0} ? 1U : 0U};
    expect_flaw(face.id, FaceId{face.id.value ^ 1U}, "is not found in its slot");
    expect_flaw(face.id, FaceId{sut().header.counts().face_ids()},
                "holds a face that the model does not have");
    expect_flaw(face.id, FaceId{}, "slots hold no face, but the pool's count differs");
    expect_flaw(face.state, FaceState::base(), "is in the base state");
    expect_flaw(face.state, FaceState::after(face.state.record(), face.state.place() ^ 1U),
                "is in a state that its record does not give");
    expect_flaw(face.corners, {other, other, other},
                "lacks the vertex of the record that changed it last");
    expect_flaw(face.corners, {face.corners[1], face.corners[2], face.corners[0]},
                "has another corner in the tree");
}

TEST_F(Validators, records_that_contradict_the_cut_are_told)
{
    const std::uint32_t slot = pinned_slot();
    const auto place = static_cast<std::uint32_t>(std::countr_zero(sut().pages.meta(slot).refined));
    const VsplitRecord& record = sut().slots.pages[slot].records[place];
    const RecordId split = unsplit_record();
    expect_flaw(record.fan_size, std::uint8_t{0}, "has no fan or too large a one");
    expect_flaw(record.before[0], FaceState::after(split, 2),
                "was split before one that it depends on");
    expect_flaw(record.star[2], sut().header.counts().face_of(split, 0),
                "is refined, and a face of its star is not active");
    expect_flaw(record.position_m[1], record.position_m[1] + 1.0F,
                "has another corner in the tree");
    const VertexForest::ActiveFace& face = changed_face();
    const std::uint32_t leaf = sut().tree.leaf_of(sut().forest.find(face.id));
    const BlockSide& side = sut().tree.side(leaf / kBlockFaces);
    const std::size_t lane = leaf % kBlockFaces;
    const VsplitRecord& last = sut().pages.resident(face.state.record());
    expect_flaw(last.error[face.state.place()], static_cast<std::uint8_t>(side.errors[lane] + 1),
                "has another error in the tree");
}

TEST_F(Validators, a_face_in_an_earlier_state_breaks_the_finest_corner_law)
{
    for (std::uint32_t i = 0; i < sut().forest.capacity(); ++i)
    {
        const VertexForest::ActiveFace& face = sut().forest.face({i});
        if (face.id.is_none() || face.state.is_base() || face.state.place() < 2)
        {
            continue;
        }
        const VsplitRecord& last = sut().pages.resident(face.state.record());
        const FaceState before = last.before[face.state.place() - 2];
        if (!before.is_base() &&
            std::ranges::count(face.corners, sut().header.counts().vertex_of(before.record())) != 0)
        {
            expect_flaw(last.depth, std::uint16_t{0}, "is no deeper than one that it depends on");
            expect_flaw(face.state, before,
                        "has a corner finer than the record that changed it last");
            return;
        }
    }
    FAIL() << "no face was changed twice";
}

TEST_F(Validators, a_record_that_is_split_behind_the_forests_back_is_told)
{
    const RecordId split = unsplit_record();
    sut().pages.set_refined(split, true);
    EXPECT_NE(flaw().find("record " + std::to_string(split.value)), std::string::npos) << flaw();
    sut().pages.set_refined(split, false);
    EXPECT_EQ(flaw(), "");
}

} // namespace tactus::test
