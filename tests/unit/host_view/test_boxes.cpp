// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/cut.hpp"
#include "rt_core/abtree/ab_tree.hpp"
#include "tests/unit/host_view/settled_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace tactus::view
{
namespace
{

using Box = std::array<float, 6>;

std::vector<Box> read_boxes(const std::string& bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data(), sizeof(count));
    EXPECT_EQ(bytes.size(), sizeof(count) + count * sizeof(Box));
    std::vector<Box> boxes(count);
    std::memcpy(boxes.data(), bytes.data() + sizeof(count), count * sizeof(Box));
    return boxes;
}

/// Boxes of a tree at work, down to a level.
void collect(const AbTree& tree, TreeRef ref, const Aabb& box, std::uint32_t level,
             std::vector<Box>& boxes)
{
    if (level == 0 || ref.is_block())
    {
        boxes.push_back(
            {box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]});
        return;
    }
    const AbNode& node = tree.node(ref.index());
    for (std::uint32_t child = 0; child < kNodeChildren; ++child)
    {
        if ((node.mask >> child & 1U) != 0)
        {
            collect(tree, node.children[child], node.box_of(child), level - 1, boxes);
        }
    }
}

class Boxes : public ::testing::Test
{
protected:
    const std::unique_ptr<tactus::test::FrameRig> rig_ = test::settled_rig();
    const std::vector<RefinementStatePage> pages_ = test::pages_of(rig_->model());
    const test::Shelved shelved_;
};

TEST_F(Boxes, of_the_tree_are_the_controllers_own_at_each_level)
{
    const auto decoded = decode_cut(*shelved_.known, pages_);
    ASSERT_TRUE(decoded.has_value()) << decoded.error().text;
    const AbTree& tree = rig_->model().tree;
    std::size_t last = 0;
    for (const std::uint32_t level : {0U, 1U, 2U, 3U, kTreeLevelsMax, 1'000'000U})
    {
        const auto bytes = tree_box_bytes(decoded.value(), pages_, level);
        ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
        std::vector<Box> shown = read_boxes(bytes.value());
        std::vector<Box> had;
        collect(tree, tree.root(), tree.box(), level, had);
        std::ranges::sort(shown);
        std::ranges::sort(had);
        EXPECT_EQ(shown, had) << level;
        EXPECT_GE(shown.size(), last);
        last = shown.size();
    }
    EXPECT_EQ(last, tree.blocks_used());
}

TEST_F(Boxes, of_chunks_hold_the_vertices_that_these_bring)
{
    const auto bytes = chunk_box_bytes(*shelved_.known, chunks_of(pages_));
    ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
    const std::vector<Box> boxes = read_boxes(bytes.value());
    ASSERT_EQ(boxes.size(), pages_.size());
    const auto decoded = decode_cut(*shelved_.known, pages_);
    ASSERT_TRUE(decoded.has_value());
    std::size_t looked = 0;
    for (std::size_t i = 0; i < pages_.size(); ++i)
    {
        for (std::uint32_t place = 0; place < kRecordsPerChunk; ++place)
        {
            if ((pages_[i].refined >> place & 1U) == 0)
            {
                continue;
            }
            const RecordId id{pages_[i].chunk.value * kRecordsPerChunk + place};
            const Vec3f at_m = decoded.value().record(id).position_m;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                EXPECT_LE(boxes[i][axis], at_m[axis]);
                EXPECT_GE(boxes[i][3 + axis], at_m[axis]);
            }
            ++looked;
        }
    }
    EXPECT_GT(looked, 20U);
    EXPECT_FALSE(chunk_box_bytes(*shelved_.known, std::vector<ChunkId>{{0xFFFFU}}).has_value());
    EXPECT_TRUE(chunk_box_bytes(*shelved_.known, {}).has_value());
}

} // namespace
} // namespace tactus::view
