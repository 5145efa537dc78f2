// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/refinement_state_tap.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tactus::hrtc::test
{

namespace
{

/// Pages of a completed frame.
std::vector<std::pair<std::uint32_t, std::uint64_t>> pages_of(Frame& frame)
{
    std::vector<std::pair<std::uint32_t, std::uint64_t>> pages;
    const PageTable& table = frame.model({0}).pages;
    for (std::uint32_t slot = 0; slot < table.capacity(); ++slot)
    {
        if (table.is_own(slot))
        {
            pages.emplace_back(table.meta(slot).chunk.value, table.meta(slot).refined);
        }
    }
    return pages;
}

/// The greatest number.
constexpr std::size_t kSlots = kMaxStatePages;
/// The last frame is the first of a hundred.
constexpr std::uint64_t kFrames = 9 * RefinementStateTap::kFrames + 1;

TEST(RefinementStateTap, copies_the_pages_of_one_frame_in_a_hundred_with_what_is_split)
{
    LoopRig rig({.meanwhile =
                     [](LoopRig& running, std::uint64_t frame)
                 {
                     if (frame == kFrames - 2)
                     {
                         running.front().give_back(); // State of the first frame; the last one
                     }                                // makes the next.
                 },
                 .frames = kFrames,
                 .front_slots = kSlots});
    EXPECT_EQ(rig.front().take(), nullptr);
    rig.run();
    const RefinementStateCopy* copy = rig.front().take();
    ASSERT_NE(copy, nullptr);
    EXPECT_EQ(copy->frame, kFrames);
    std::vector<std::pair<std::uint32_t, std::uint64_t>> pages;
    std::uint64_t split = 0;
    for (const ShownPage& slot : copy->slots)
    {
        if (!slot.chunk.is_none())
        {
            EXPECT_EQ(slot.owner, 0U);
            pages.emplace_back(slot.chunk.value, slot.refined);
            split |= slot.refined;
        }
    }
    EXPECT_EQ(pages, pages_of(rig.frame()));
    EXPECT_NE(split, 0U);
    EXPECT_EQ(copy->slots_left_out, 0U);
    ASSERT_EQ(copy->tools.size(), 1U);
    EXPECT_EQ(copy->times[kStages].count, kFrames);
}

TEST(RefinementStateTap, leaves_a_copy_alone_until_it_is_given_back)
{
    std::vector<ShownPage> first;
    LoopRig rig({.meanwhile =
                     [&first](LoopRig& running, std::uint64_t frame)
                 {
                     if (frame == 1)
                     {
                         first = running.front().take()->slots;
                     }
                 },
                 .frames = kFrames,
                 .front_slots = kSlots});
    RefinementStateTap& sut = rig.front();
    rig.run();
    ASSERT_NE(sut.take(), nullptr);
    EXPECT_EQ(sut.take()->frame, 1U);
    EXPECT_EQ(sut.take()->slots, first);
    const std::span<const PageMeta> last = rig.frame().pools().cache.pages.metas;
    EXPECT_FALSE(std::equal(first.begin(), first.end(), last.begin(), last.end()));
    sut.give_back();
    EXPECT_EQ(sut.take(), nullptr);
}

TEST(RefinementStateTap, starts_from_what_is_there_when_it_is_made)
{
    LoopRig rig({.frames = kFrames});
    rig.loop().run();
    PagePool& pages = rig.frame().pools().cache.pages;
    std::vector<ShownPage> there(pages.metas.begin(), pages.metas.end());
    pages.update_copy(there); // No change is left.
    RefinementStateTap sut(pages);
    sut.show({0, {}, {}, Budgets{}}, rig.statistics());
    EXPECT_EQ(sut.take()->slots, there);
}

TEST(RefinementStateTap, counts_slots_for_which_it_has_no_room)
{
    LoopRig rig({.frames = 1, .front_slots = 2});
    const RefinementStateTap& sut = rig.front();
    rig.loop().run();
    ASSERT_NE(sut.take(), nullptr);
    EXPECT_EQ(sut.take()->slots.size(), 2U);
    EXPECT_EQ(sut.take()->slots_left_out, rig.frame().pools().cache.pages.metas.size() - 2);
}

TEST(RefinementStateTap, copies_where_chunks_are_looked_for)
{
    // No pages of a fully resident model are searched.
    LoopRig rig({.frames = 1, .front_slots = kSlots, .is_coarse = true});
    const RefinementStateTap& sut = rig.front();
    rig.loop().run();
    ASSERT_NE(sut.take(), nullptr);
    const std::span<const RankedRegion> regions = rig.frame().regions();
    ASSERT_FALSE(regions.empty());
    ASSERT_EQ(sut.take()->regions.size(), std::min(regions.size(), kMaxStateRegions));
    for (std::size_t i = 0; i < sut.take()->regions.size(); ++i)
    {
        const RefinementStateRegion& copy = sut.take()->regions[i];
        EXPECT_EQ(copy.model, regions[i].model.value);
        EXPECT_EQ(copy.is_predicted, regions[i].horizon_ns > 0);
        EXPECT_EQ(copy.radius_m, static_cast<float>(regions[i].radius_m));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            EXPECT_EQ(copy.center_m[axis],
                      static_cast<float>(regions[i].center_m[static_cast<int>(axis)]));
        }
    }
}

TEST(RefinementStateTap, changes_nothing_that_the_loop_does)
{
    LoopRig with({.frames = 500, .front_slots = kSlots});
    LoopRig without({.frames = 500});
    const auto run = [](LoopRig& rig)
    {
        rig.loop().run();
        return std::pair(rig.device().written_n, rig.statistics().models.front().state_hash);
    };
    EXPECT_EQ(run(with), run(without));
    EXPECT_EQ(with.statistics().deadlines.allocations, without.statistics().deadlines.allocations);
}

} // namespace

} // namespace tactus::hrtc::test
