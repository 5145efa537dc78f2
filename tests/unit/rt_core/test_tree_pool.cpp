// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Trees that share a pool: each stays sound and separate under any changes of all, and none takes
/// another's reserve.

#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kTrees = 3;
constexpr std::uint32_t kPrimsEach = 200;

/// Trees with separate prims in one pool.
class SharedTrees
{
public:
    SharedTrees(const TreeCapacities& capacities, const TreeCapacities& least)
        : memory_(TreeRig::required(capacities))
    {
        Arena arena(memory_.bytes());
        pool.emplace(arena, capacities);
        for (std::uint32_t i = 0; i < kTrees; ++i)
        {
            trees[i].emplace(*pool, ModelId{i}, least, kTreeQuantum);
        }
    }

    void insert(std::uint32_t tree, const ChangedFace& face)
    {
        trees[tree]->insert(face);
        faces[tree].push_back(face);
    }
    /// Removes the face at that place of the list.
    void remove(std::uint32_t tree, std::size_t at)
    {
        trees[tree]->remove(faces[tree][at].prim);
        faces[tree].erase(faces[tree].begin() + static_cast<std::ptrdiff_t>(at));
    }
    void offer_again(std::uint32_t tree)
    {
        trees[tree]->offer_unplaced(
            [&](PrimId prim)
            {
                return *std::ranges::find_if(faces[tree], [&](const ChangedFace& face)
                                             { return face.prim == prim; });
            });
    }
    [[nodiscard]] std::string faults(std::uint32_t tree) const
    {
        return tree_faults(*trees[tree], faces[tree]);
    }

    ArenaMemory memory_;

public:
    std::optional<TreePool> pool;
    std::array<std::optional<AbTree>, kTrees> trees;
    std::array<std::vector<ChangedFace>, kTrees> faces;
};

/// Face of a tree's own prims; all trees have faces of the same ids. Four or five fill a block.
ChangedFace own_face(Random& random, std::uint32_t tree, std::uint32_t number)
{
    return random_face(random, face_styles()[3], tree * kPrimsEach + number, number);
}

} // namespace

TEST(TreePool, has_all_of_it_at_first_and_again_when_all_trees_are_empty)
{
    SharedTrees sut({kTrees * kPrimsEach, 300, 200}, {});
    Random random(3);
    for (std::uint32_t tree = 0; tree < kTrees; ++tree)
    {
        for (std::uint32_t i = 0; i < kPrimsEach; ++i)
        {
            sut.insert(tree, own_face(random, tree, i));
        }
        sut.trees[tree]->refit();
        EXPECT_TRUE(sut.trees[tree]->is_complete());
    }
    for (std::uint32_t tree = 0; tree < kTrees; ++tree)
    {
        EXPECT_EQ(sut.faults(tree), "");
        while (!sut.faces[tree].empty())
        {
            sut.remove(tree, sut.faces[tree].size() / 2);
        }
        sut.trees[tree]->refit();
        EXPECT_EQ(sut.trees[tree]->blocks_used() + sut.trees[tree]->nodes_used(), 0U);
    }
    const TreeShare all = sut.pool->promise({0, 300, 200});
    EXPECT_EQ(all.blocks.promised, 300U);
    EXPECT_EQ(all.nodes.promised, 200U);
    EXPECT_TRUE(sut.pool->has_room_for(all, 200));
    EXPECT_FALSE(sut.pool->has_room_for(all, 201));
}

TEST(TreePool, trees_that_change_in_turns_stay_sound_and_their_own)
{
    // The pool is sometimes large enough for all.
    for (const std::uint32_t blocks : {400U, 90U})
    {
        SharedTrees sut({kTrees * kPrimsEach, blocks, blocks}, {0, 20, 20});
        Random random(4);
        bool was_full = false;
        for (int batch = 0; batch < 200; ++batch)
        {
            // Several trees change before a refit: one may take blocks that another frees.
            for (int change = 0; change < 60; ++change)
            {
                const std::uint32_t tree = random.below(kTrees);
                const std::uint32_t number = random.below(kPrimsEach);
                const auto at =
                    std::ranges::find_if(sut.faces[tree], [&](const ChangedFace& face)
                                         { return face.prim.value == tree * kPrimsEach + number; });
                if (at == sut.faces[tree].end())
                {
                    sut.insert(tree, own_face(random, tree, number));
                }
                else
                {
                    sut.remove(tree, static_cast<std::size_t>(at - sut.faces[tree].begin()));
                }
            }
            for (std::uint32_t tree = 0; tree < kTrees; ++tree)
            {
                sut.offer_again(tree);
                sut.trees[tree]->refit();
                was_full = was_full || !sut.trees[tree]->is_complete();
            }
            for (std::uint32_t tree = 0; tree < kTrees; ++tree)
            {
                ASSERT_EQ(sut.faults(tree), "") << "batch " << batch << " tree " << tree;
            }
        }
        EXPECT_EQ(was_full, blocks == 90);
    }
}

TEST(TreePool, what_is_freed_while_it_waits_for_refit_is_the_pool_s_after_it)
{
    SharedTrees sut({kTrees * kPrimsEach, 300, 300}, {});
    Random random(6);
    sut.insert(0, own_face(random, 0, 0));
    sut.remove(0, 0);
    EXPECT_EQ(sut.trees[0]->blocks_used(), 0U);
    sut.insert(1, own_face(random, 1, 0));
    sut.trees[0]->refit();
    sut.trees[1]->refit();
    EXPECT_EQ(sut.faults(0), "");
    EXPECT_EQ(sut.faults(1), "");
    EXPECT_EQ(sut.trees[1]->blocks_used(), 1U);
    EXPECT_FALSE(sut.trees[0]->is_block_in_use(sut.trees[1]->root().index()));
    EXPECT_TRUE(sut.trees[1]->is_block_in_use(sut.trees[1]->root().index()));
}

TEST(TreePool, refuses_more_owners_than_a_byte_tells_apart)
{
    SharedTrees sut({1, 1, 1}, {});
    const AbTree last(*sut.pool, ModelId{kMaxModels - 1}, {}, kTreeQuantum);
    EXPECT_TRUE(last.is_complete());
    EXPECT_DEATH(AbTree(*sut.pool, ModelId{kMaxModels}, {}, kTreeQuantum), "");
}

} // namespace tactus::test
