// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The 3DIM 2005 paper's three states over the life of a node, the links up from it, and the index
/// list down to it.

#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <set>

namespace tactus::test
{

namespace
{

/// Faces 0 .. count - 1, five vertices apart in path and place, so that a block holds a few.
ChangedFace spread_face(std::uint32_t prim)
{
    const auto at = static_cast<float>(prim);
    return {PrimId{prim},
            FaceId{prim},
            prim * 64,
            0,
            {{{at, 0.0F, 0.0F}, {at + 0.5F, 0.0F, 0.0F}, {at, 0.5F, 0.0F}}}};
}

TreeRef block_ref(const AbTree& tree, std::uint32_t prim)
{
    return TreeRef::to_block(tree.leaf_of(PrimId{prim}) / kBlockFaces);
}

/// All nodes from a block's parent up to the root.
std::vector<std::uint32_t> nodes_above(const AbTree& tree, TreeRef block)
{
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t node = tree.side(block.index()).parent; node != kNoNode;
         node = tree.node(node).parent)
    {
        nodes.push_back(node);
    }
    return nodes;
}

} // namespace

TEST(NodeStatus, of_a_block_goes_from_inactive_over_active_and_deformed_and_back)
{
    TreeRig rig({64, 128, 128});
    for (std::uint32_t prim = 0; prim < 40; ++prim)
    {
        rig.put(spread_face(prim));
    }
    rig.sut->refit();
    std::set<std::uint32_t> blocks;
    for (std::uint32_t prim = 0; prim < 40; ++prim)
    {
        blocks.insert(block_ref(*rig.sut, prim).value);
    }
    ChangedFace lone = spread_face(50);
    lone.bucket = 0x7000'0000U; // Far from all others in path space: a separate block.

    rig.put(lone);
    const TreeRef sut = block_ref(*rig.sut, 50);
    ASSERT_EQ(blocks.count(sut.value), 0U) << "the block was not in the tree before";
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::deformed) << "new: waits for its first box";
    rig.sut->refit();
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::active);

    lone.corners_m[0][2] = 3.0F;
    rig.put(lone);
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::deformed);
    for (const std::uint32_t block : blocks)
    {
        EXPECT_EQ(rig.sut->status(TreeRef{block}), NodeStatus::active) << "not touched";
    }
    rig.sut->refit();
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::active);

    rig.remove(50);
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::inactive) << "at once, not only after refit";
    rig.sut->refit();
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::inactive);
    EXPECT_EQ(rig.faults(), "");
}

TEST(NodeStatus, of_an_inner_node_goes_from_inactive_over_active_and_deformed_and_back)
{
    TreeRig rig({64, 128, 128});
    for (std::uint32_t prim = 0; prim < 5; ++prim)
    {
        rig.put(spread_face(prim));
    }
    rig.sut->refit();
    ASSERT_TRUE(rig.sut->root().is_block());

    for (std::uint32_t prim = 5; prim < 40; ++prim)
    {
        rig.put(spread_face(prim));
    }
    const TreeRef sut = rig.sut->root();
    ASSERT_FALSE(sut.is_block());
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::deformed);
    rig.sut->refit();
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::active);

    // A node that loses or exchanges a child is deformed; a removed one is inactive.
    bool was_deformed = false;
    for (std::uint32_t prim = 39; prim > 0; --prim)
    {
        rig.remove(prim);
        was_deformed = was_deformed || rig.sut->status(sut) == NodeStatus::deformed;
        rig.sut->refit();
        EXPECT_NE(rig.sut->status(sut), NodeStatus::deformed) << "prim " << prim;
    }
    EXPECT_TRUE(was_deformed);
    ASSERT_TRUE(rig.sut->root().is_block());
    EXPECT_EQ(rig.sut->status(sut), NodeStatus::inactive);
    EXPECT_EQ(rig.faults(), "");
}

TEST(NodeStatus, no_node_stays_deformed_after_refit_and_every_one_below_the_root_is_active)
{
    Random random(60);
    TreeRig rig({400, 600, 600});
    for (int batch = 0; batch < 60; ++batch)
    {
        for (std::uint32_t i = 0; i < 30; ++i)
        {
            const std::uint32_t prim = random.below(400);
            random.one_in(3) ? rig.remove(prim)
                             : rig.put(random_face(random, face_styles()[1], prim, prim));
        }
        rig.sut->refit();
        std::uint32_t active = 0;
        for (std::uint32_t i = 0; i < 600; ++i)
        {
            for (const TreeRef ref : {TreeRef::to_block(i), TreeRef::to_node(i)})
            {
                EXPECT_NE(rig.sut->status(ref), NodeStatus::deformed) << "batch " << batch;
                active += rig.sut->status(ref) == NodeStatus::active ? 1U : 0U;
            }
        }
        EXPECT_EQ(active, rig.sut->blocks_used() + rig.sut->nodes_used()) << "batch " << batch;
    }
}

TEST(ParentLinks, lead_from_every_block_to_the_root_and_back_down)
{
    Random random(61);
    for (const FaceStyle& style : face_styles())
    {
        TreeRig rig({300, 500, 500});
        for (std::uint32_t prim = 0; prim < 300; ++prim)
        {
            rig.put(random_face(random, style, prim, prim));
        }
        rig.sut->refit();
        for (std::uint32_t prim = 0; prim < 300; ++prim)
        {
            TreeRef below = block_ref(*rig.sut, prim);
            for (const std::uint32_t node : nodes_above(*rig.sut, below))
            {
                const AbNode& above = rig.sut->node(node);
                const std::uint32_t child = below.is_block() ? rig.sut->side(below.index()).child
                                                             : rig.sut->node(below.index()).child;
                ASSERT_EQ(above.children[child], below) << style.name << ", prim " << prim;
                EXPECT_EQ(rig.sut->status(TreeRef::to_node(node)), NodeStatus::active);
                below = TreeRef::to_node(node);
            }
            EXPECT_EQ(below, rig.sut->root()) << style.name << ", prim " << prim;
        }
    }
}

TEST(IndexList, finds_the_block_of_every_active_face_and_of_no_other)
{
    Random random(62);
    TreeRig rig({300, 500, 500});
    std::set<std::uint32_t> present;
    for (int batch = 0; batch < 40; ++batch)
    {
        for (std::uint32_t i = 0; i < 40; ++i)
        {
            const std::uint32_t prim = random.below(300);
            if (random.one_in(3))
            {
                rig.remove(prim);
                present.erase(prim);
            }
            else
            {
                rig.put(random_face(random, face_styles()[0], prim, 1'000 + prim));
                present.insert(prim);
            }
        }
        rig.sut->refit();
        for (std::uint32_t prim = 0; prim < 300; ++prim)
        {
            const std::uint32_t leaf = rig.sut->leaf_of(PrimId{prim});
            ASSERT_EQ(leaf != AbTree::kNoLeaf, present.count(prim) == 1) << "prim " << prim;
            if (leaf == AbTree::kNoLeaf)
            {
                continue;
            }
            const BlockSide& side = rig.sut->side(leaf / kBlockFaces);
            EXPECT_EQ(side.prims[leaf % kBlockFaces], PrimId{prim});
            EXPECT_EQ(rig.sut->face_of(PrimId{prim}), FaceId{1'000 + prim});
            EXPECT_EQ(rig.sut->status(block_ref(*rig.sut, prim)), NodeStatus::active);
        }
    }
}

} // namespace tactus::test
