// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/refinement_state_tap.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

TEST(TelemetryTap, has_nothing_before_the_first_frame)
{
    const TelemetryTap sut(kPeriod);
    Telemetry telemetry;
    telemetry.frame = 7;
    EXPECT_FALSE(sut.try_read(telemetry));
    EXPECT_EQ(telemetry.frame, 7U);
}

TEST(TelemetryTap, shows_the_newest_frame_as_the_loop_had_it)
{
    LoopRig rig({.frames = kSettled});
    rig.loop().run();
    Telemetry telemetry;
    ASSERT_TRUE(rig.telemetry.try_read(telemetry));
    EXPECT_EQ(telemetry.frame, kSettled);
    EXPECT_EQ(telemetry.period_ns, kPeriod.ns);
    EXPECT_EQ(telemetry.exact, rig.statistics().answers.exact);
    EXPECT_EQ(telemetry.separated, rig.statistics().answers.separated);
    EXPECT_EQ(telemetry.exact + telemetry.separated + telemetry.within_tolerance +
                  telemetry.bounded + telemetry.stale,
              kSettled);
    EXPECT_EQ(telemetry.tool_count, 1U);
    EXPECT_EQ(telemetry.model_count, 1U);
    EXPECT_EQ(telemetry.models[0].pages.capacity, rig.statistics().models[0].pages.capacity);
    EXPECT_EQ(telemetry.models[0].faces.used, rig.statistics().models[0].faces.used);
    EXPECT_GT(telemetry.models[0].faces.used, 0U);
    EXPECT_TRUE(telemetry.tools[0].in_contact);
    const Vec3& sent_n = rig.written_n(kSettled - 1);
    EXPECT_EQ(telemetry.tools[0].force_n[0], sent_n.x());
    EXPECT_EQ(telemetry.tools[0].force_n[2], sent_n.z());
    EXPECT_GT(telemetry.tools[0].proxy_m[0], telemetry.tools[0].position_m[0]); // Pressed in -x.
    EXPECT_EQ(telemetry.tools[0].rotation, (std::array{0.0, 0.0, 0.0, 1.0}));
    ASSERT_EQ(telemetry.pair_count, 1U);
    EXPECT_EQ(telemetry.pairs[0].tool, 0U);
    EXPECT_EQ(telemetry.pairs[0].object, 0U);
    EXPECT_EQ(telemetry.pairs[0].kind, AnswerKind::exact);
    EXPECT_LE(telemetry.pairs[0].lower_m, telemetry.pairs[0].upper_m);
    EXPECT_EQ(telemetry.pairs[0].force_n[0], -sent_n.x()); // The whole force is on the one object.
    EXPECT_EQ(telemetry.pairs[0].force_n[2], -sent_n.z());
}

TEST(ObjectTap, leaves_a_copy_alone_until_it_is_given_back)
{
    LoopRig rig({.frames = 10});
    ObjectTap& sut = rig.telemetry.objects();
    EXPECT_EQ(sut.take(), nullptr);
    rig.loop().run();
    const ObjectsCopy* copy = sut.take();
    ASSERT_NE(copy, nullptr);
    const ObjectTable& objects = rig.frame().objects();
    EXPECT_EQ(copy->sweep_begin, 0U);
    EXPECT_EQ(copy->sweep_end, std::min(kObjectSweep, objects.capacity()));
    ASSERT_EQ(copy->objects.size(), 1U);
    EXPECT_EQ(copy->objects[0].number, 0U);
    EXPECT_EQ(copy->objects[0].pose.translation_m, objects[0].pose.translation_m);
    sut.show(objects, {});
    EXPECT_EQ(sut.take(), copy);
    sut.give_back(true);
    EXPECT_EQ(sut.take(), nullptr);
}

TEST(ObjectTap, lists_objects_of_pairs_once_and_in_turn_all_others)
{
    LoopRig rig({.frames = 1});
    rig.loop().run();
    const ObjectTable& objects = rig.frame().objects();
    std::array<PairOutput, 2> pairs{}; // Two tools near object 0.
    ObjectTap sut;
    sut.show(objects, pairs);
    EXPECT_EQ(sut.take()->objects.size(), 1U);
    sut.give_back(false);
    sut.show(objects, pairs);
    EXPECT_EQ(sut.take()->sweep_begin, 0U) << "the range was not sent";
    sut.give_back(true);
    sut.show(objects, pairs);
    EXPECT_EQ(sut.take()->sweep_begin, objects.capacity() > kObjectSweep ? kObjectSweep : 0U);
}

TEST(TelemetryTap, sends_no_gripper_that_is_no_number)
{
    for (const double gripper_m :
         {0.03, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        LoopRig rig({.tamper =
                         [gripper_m](std::uint64_t, DeviceSample& sample)
                     {
                         sample.buttons = 5;
                         sample.gripper_m = gripper_m;
                     },
                     .frames = 10});
        rig.loop().run();
        Telemetry telemetry;
        ASSERT_TRUE(rig.telemetry.try_read(telemetry));
        EXPECT_EQ(telemetry.tools[0].buttons, 5U);
        EXPECT_EQ(telemetry.tools[0].has_gripper, std::isfinite(gripper_m));
        EXPECT_EQ(telemetry.tools[0].gripper_m, std::isfinite(gripper_m) ? gripper_m : 0.0);
    }
}

/// Pair of a tool at the origin and an object that begins at this distance in that direction.
PairOutput pair_towards(const Vec3& inward, double distance_m)
{
    PairOutput pair;
    pair.nearest_point_m = distance_m * inward.normalized();
    pair.lower_m = pair.upper_m = distance_m;
    return pair;
}

TEST(SharePush, gives_each_wall_of_a_corner_its_part_and_nothing_to_what_is_not_touched)
{
    const std::array pairs{pair_towards(Vec3(1.0, 0.0, 0.0), 0.01),
                           pair_towards(Vec3(0.0, 1.0, 0.0), 0.01),
                           pair_towards(Vec3(0.0, 0.0, 1.0), 0.02)};
    std::array<Vec3, 3> pushes_n;
    share_push(pairs, 0.01, Vec3(3.0, 2.0, 0.0), pushes_n);
    EXPECT_LT((pushes_n[0] - Vec3(3.0, 0.0, 0.0)).norm(), 1e-9);
    EXPECT_LT((pushes_n[1] - Vec3(0.0, 2.0, 0.0)).norm(), 1e-9);
    EXPECT_EQ(pushes_n[2].norm(), 0.0);
}

TEST(SharePush, adds_up_to_the_push_whatever_the_normals_are)
{
    const std::array pairs{pair_towards(Vec3(1.0, 0.1, 0.0), 0.01),
                           pair_towards(Vec3(1.0, -0.1, 0.3), 0.01),
                           pair_towards(Vec3(-1.0, 0.0, 0.0), 0.01)};
    std::array<Vec3, 3> pushes_n;
    const Vec3 push_n(3.0, 2.0, -1.0); // Force with friction.
    share_push(pairs, 0.01, push_n, pushes_n);
    EXPECT_LT((pushes_n[0] + pushes_n[1] + pushes_n[2] - push_n).norm(), 1e-12);
    EXPECT_LT(pushes_n[2].norm(), 1e-12); // The object would have to pull.
}

TEST(SharePush, leaves_a_push_that_no_normal_explains_to_the_nearest)
{
    const std::array pairs{pair_towards(Vec3(1.0, 0.0, 0.0), 0.012),
                           pair_towards(Vec3(1.0, 0.0, 0.0), 0.011)};
    std::array<Vec3, 2> pushes_n;
    share_push(pairs, 0.01, Vec3(-1.0, 0.0, 0.0), pushes_n);
    EXPECT_EQ(pushes_n[0].norm(), 0.0);
    EXPECT_EQ(pushes_n[1].x(), -1.0);
    share_push({}, 0.01, Vec3(-1.0, 0.0, 0.0), {});
}

TEST(TelemetryTap, keeps_the_faults_of_frames_that_nobody_looked_at)
{
    LoopRig rig({.tamper = [](std::uint64_t frame, DeviceSample& sample)
                 { sample.valid = frame != kSettled; }});
    rig.loop().run();
    Telemetry telemetry;
    ASSERT_TRUE(rig.telemetry.try_read(telemetry));
    const auto invalid = static_cast<std::uint32_t>(FrameFault::tool_invalid);
    EXPECT_EQ(telemetry.faults_now & invalid, 0U);
    EXPECT_EQ(telemetry.faults_seen & invalid, invalid);
}

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
constexpr std::uint64_t kTappedFrames = 9 * RefinementStateTap::kFrames + 1;

TEST(RefinementStateTap, copies_the_pages_of_one_frame_in_a_hundred_with_what_is_split)
{
    LoopRig rig({.meanwhile =
                     [](LoopRig& running, std::uint64_t frame)
                 {
                     if (frame == kTappedFrames - 2)
                     {
                         running.front().give_back(); // State of the first frame; the last one
                     }                                // makes the next.
                 },
                 .frames = kTappedFrames,
                 .front_slots = kSlots});
    EXPECT_EQ(rig.front().take(), nullptr);
    rig.run();
    const RefinementStateCopy* copy = rig.front().take();
    ASSERT_NE(copy, nullptr);
    EXPECT_EQ(copy->frame, kTappedFrames);
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
    EXPECT_EQ(copy->times[kStages].count, kTappedFrames);
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
                 .frames = kTappedFrames,
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
    LoopRig rig({.frames = kTappedFrames});
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
