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

} // namespace tactus::test
