// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I6: boxes hold their faces inflated by e, and equal those of a tree refitted from scratch.

#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

namespace
{

ChangedFace unit_face(std::uint32_t prim, std::uint32_t bucket, std::uint32_t vertex_seed)
{
    const auto at = static_cast<float>(vertex_seed);
    return {PrimId{prim},
            FaceId{prim},
            bucket,
            0,
            {{{at, 0.0F, 0.0F}, {at + 0.5F, 0.0F, 0.0F}, {at, 0.5F, 0.0F}}}};
}

/// Random inserts, updates, removals and replacements in batches, a refit and a full check after
/// each.
void run_random_changes(const FaceStyle& style, const TreeCapacities& capacities,
                        std::uint64_t own_seed, int batches)
{
    Random random(own_seed);
    TreeRig rig(capacities);
    std::uint32_t next_face = 0;
    std::uint32_t fullness = 50;
    for (int batch = 0; batch < batches; ++batch)
    {
        // The share of used prims varies, so that the tree grows and shrinks.
        fullness = batch % 10 == 0 ? random.below(101) : fullness;
        rig.offer_again();
        const std::uint32_t changes = 1 + random.below(60);
        for (std::uint32_t i = 0; i < changes; ++i)
        {
            const std::uint32_t prim = random.below(capacities.prims);
            const bool is_there = !rig.face(prim).face.is_none();
            if (random.below(100) >= fullness)
            {
                rig.remove(prim);
            }
            else if (is_there && !random.one_in(4))
            {
                rig.put(random_face(random, style, prim, rig.face(prim).face.value));
            }
            else
            {
                rig.put(random_face(random, style, prim, next_face++));
            }
        }
        rig.sut->refit();
        ASSERT_EQ(rig.faults(), "") << style.name << " batch " << batch;
    }
}

} // namespace

TEST(AbTree, an_empty_tree_has_no_root_and_needs_no_refit)
{
    TreeRig rig({4, 64, 64});

    const AbTree::RefitWork work = rig.sut->refit();

    EXPECT_TRUE(rig.sut->root().is_none());
    EXPECT_TRUE(rig.sut->is_complete());
    EXPECT_EQ(work.blocks + work.nodes, 0U);
    EXPECT_EQ(rig.faults(), "");
}

TEST(AbTree, one_face_is_one_block_and_leaves_nothing_behind)
{
    TreeRig rig({4, 64, 64});

    rig.put(unit_face(2, 5, 0));
    EXPECT_EQ(rig.sut->status(rig.sut->root()), NodeStatus::deformed);
    rig.sut->refit();

    EXPECT_EQ(rig.faults(), "");
    EXPECT_EQ(rig.sut->status(rig.sut->root()), NodeStatus::active);
    EXPECT_EQ(rig.sut->blocks_used(), 1U);
    EXPECT_EQ(rig.sut->nodes_used(), 0U);
    const TreeRef root = rig.sut->root();
    rig.remove(2);
    rig.sut->refit();
    EXPECT_TRUE(rig.sut->root().is_none());
    EXPECT_EQ(rig.sut->status(root), NodeStatus::inactive);
    EXPECT_EQ(rig.sut->blocks_used(), 0U);
    EXPECT_EQ(rig.sut->blocks_used_max(), 1U);
}

TEST(AbTree, sixteen_faces_over_few_vertices_are_one_block_and_the_seventeenth_splits_it)
{
    TreeRig rig({32, 64, 64});
    for (std::uint32_t prim = 0; prim < 16; ++prim)
    {
        rig.put(unit_face(prim, 1, prim % 4));
        rig.sut->refit();
        ASSERT_EQ(rig.faults(), "");
    }
    EXPECT_EQ(rig.sut->blocks_used(), 1U);

    rig.put(unit_face(16, 1, 0));
    rig.sut->refit();

    EXPECT_EQ(rig.faults(), "");
    EXPECT_TRUE(rig.sut->is_complete());
    EXPECT_GE(rig.sut->blocks_used(), 2U);
    EXPECT_GE(rig.sut->nodes_used(), 1U);
}

TEST(AbTree, refit_visits_no_more_than_has_changed)
{
    Random random(32);
    TreeRig rig({300, 400, 400});
    fill_style(rig, random, face_styles()[0], 300);
    const std::uint32_t nodes = rig.sut->nodes_used();

    AbTree::RefitWork work = rig.sut->refit();
    EXPECT_EQ(work.blocks + work.nodes, 0U) << "nothing has changed";

    rig.put(rig.face(17));
    work = rig.sut->refit();
    EXPECT_EQ(work.blocks, 1U) << "its box is unchanged";
    EXPECT_EQ(work.nodes, 0U);

    ChangedFace moved = rig.face(17);
    moved.corners_m[0][1] += 50.0F;
    rig.put(moved);
    work = rig.sut->refit();
    std::uint32_t depth = 0;
    const std::uint32_t leaf = rig.sut->leaf_of({17});
    for (std::uint32_t node = rig.sut->side(leaf / kBlockFaces).parent; node != kNoNode;
         node = rig.sut->node(node).parent)
    {
        ++depth;
    }
    EXPECT_LE(work.blocks, 2U);
    EXPECT_LE(work.nodes, depth + 1);
    EXPECT_LT(work.nodes, nodes);
    EXPECT_EQ(rig.faults(), "");
}

TEST(AbTree, random_changes_keep_it_sound_in_every_style)
{
    for (const FaceStyle& style : face_styles())
    {
        run_random_changes(style, {400, 600, 600}, 33, 120);
    }
}

TEST(AbTree, random_changes_keep_it_sound_while_pools_run_out)
{
    for (const FaceStyle& style : face_styles())
    {
        run_random_changes(style, {300, 40, 30}, 34, 150);
        run_random_changes(style, {300, 24, 200}, 35, 100);
        run_random_changes(style, {300, 200, 22}, 36, 100);
    }
}

TEST(AbTree, pools_below_the_reserve_place_nothing_and_say_so)
{
    TreeRig rig({4, AbTree::kReserve - 1, 64});

    rig.put(unit_face(0, 1, 0));
    rig.sut->refit();

    EXPECT_FALSE(rig.sut->is_complete());
    EXPECT_TRUE(rig.sut->is_unplaced({0}));
    EXPECT_TRUE(rig.sut->root().is_none());
    EXPECT_FALSE(rig.sut->has_room_for(0));
    EXPECT_EQ(rig.faults(), "");
}

TEST(AbTree, faces_without_a_place_find_one_when_others_have_left)
{
    TreeRig rig({300, 30, 30});
    for (std::uint32_t prim = 0; prim < 300; ++prim)
    {
        rig.put(unit_face(prim, prim * 0x0100'0193U, prim));
    }
    rig.sut->refit();
    ASSERT_FALSE(rig.sut->is_complete());
    ASSERT_EQ(rig.faults(), "");

    for (std::uint32_t prim = 20; prim < 300; ++prim)
    {
        rig.remove(prim);
    }
    rig.offer_again();
    rig.sut->refit();

    EXPECT_TRUE(rig.sut->is_complete());
    EXPECT_EQ(rig.faults(), "");
}

TEST(AbTree, removing_all_faces_gives_every_block_and_node_back)
{
    for (const FaceStyle& style : face_styles())
    {
        Random random(37);
        TreeRig rig({500, 700, 700});
        fill_style(rig, random, style, 500);
        EXPECT_TRUE(rig.sut->has_room_for(0));
        for (std::uint32_t prim = 0; prim < 500; ++prim)
        {
            rig.remove((prim * 7) % 500);
            rig.sut->refit();
        }
        EXPECT_EQ(rig.sut->blocks_used(), 0U) << style.name;
        EXPECT_EQ(rig.sut->nodes_used(), 0U) << style.name;
        EXPECT_TRUE(rig.sut->root().is_none()) << style.name;
        EXPECT_TRUE(rig.sut->has_room_for(700 - AbTree::kReserve)) << style.name;
        EXPECT_FALSE(rig.sut->has_room_for(700 - AbTree::kReserve + 1)) << style.name;
    }
}

TEST(AbTree, faces_whose_paths_differ_only_in_the_last_bit_are_told_apart)
{
    // Odd multiplier: ids 2^31 apart differ in the highest mixed bit only, ids chosen by the
    // inverse in the lowest only.
    std::uint32_t inverse = 0x9E37'79B9U;
    for (int i = 0; i < 5; ++i)
    {
        inverse *= 2U - 0x9E37'79B9U * inverse;
    }
    TreeRig rig({64, 128, 128});
    for (std::uint32_t prim = 0; prim < 40; ++prim)
    {
        ChangedFace face = unit_face(prim, 3, prim);
        face.face = FaceId{prim * inverse};
        rig.put(face);
        rig.sut->refit();
        ASSERT_EQ(rig.faults(), "") << prim;
    }
    EXPECT_TRUE(rig.sut->is_complete());
}

} // namespace tactus::test
