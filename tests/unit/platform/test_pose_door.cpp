// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/remote/pose_door.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace tactus
{

namespace
{

constexpr Duration kLimit = milliseconds(100);
constexpr MonotonicTime kStart{1'000'000'000};

/// One number in every field.
ObjectPose pose_of(double number)
{
    ObjectPose pose;
    pose.rotation.setConstant(number);
    pose.translation_m = Vec3(number, number, number);
    pose.scale = number;
    pose.stamp_ns = static_cast<std::int64_t>(number);
    pose.revision = static_cast<std::uint32_t>(number);
    return pose;
}

bool is_whole(const ObjectPose& pose)
{
    const double number = pose.scale;
    return pose.rotation == pose_of(number).rotation &&
           pose.translation_m == pose_of(number).translation_m &&
           pose.stamp_ns == pose_of(number).stamp_ns && pose.revision == pose_of(number).revision;
}

TEST(PoseDoor, leaves_what_nobody_moves_where_it_was_placed_and_young)
{
    const std::vector<ObjectPose> placed{pose_of(1.0), pose_of(2.0)};
    PoseDoor sut(placed, kLimit);
    sut.put(1, pose_of(5.0), kStart);
    sut.refresh(kStart + milliseconds(500));
    EXPECT_EQ(sut.poses()[0].scale, 1.0);
    EXPECT_EQ(sut.poses()[0].age_ns, 0);
    EXPECT_FALSE(sut.uses()[0].is_followed);
    EXPECT_TRUE(sut.uses()[1].is_followed);
    EXPECT_EQ(sut.poses()[1].scale, 5.0);
    EXPECT_TRUE(is_whole(sut.poses()[1]));
}

TEST(PoseDoor, counts_the_age_from_the_arrival_on_its_own_clock)
{
    const std::vector<ObjectPose> placed{pose_of(1.0)};
    PoseDoor sut(placed, kLimit);
    ObjectPose pose = pose_of(2.0);
    pose.stamp_ns = 1; // Whatever the host's clock says.
    pose.age_ns = 77;
    sut.put(0, pose, kStart);
    sut.refresh(kStart + milliseconds(3));
    EXPECT_EQ(sut.poses()[0].age_ns, 3'000'000);
    EXPECT_EQ(sut.poses()[0].stamp_ns, 1);
    sut.refresh(kStart + kLimit);
    EXPECT_EQ(sut.uses()[0].old_frames, 0U);
    sut.refresh(kStart + kLimit + nanoseconds(1));
    EXPECT_EQ(sut.uses()[0].old_frames, 1U);
    EXPECT_EQ(sut.uses()[0].age_max.ns, kLimit.ns + 1);
    sut.put(0, pose, kStart + milliseconds(200));
    sut.refresh(kStart + milliseconds(201));
    EXPECT_EQ(sut.poses()[0].age_ns, 1'000'000);
}

TEST(PoseDoor, takes_what_came_after_the_frame_began_as_new)
{
    const std::vector<ObjectPose> placed{pose_of(1.0)};
    PoseDoor sut(placed, kLimit);
    sut.put(0, pose_of(2.0), kStart + microseconds(5));
    sut.refresh(kStart);
    EXPECT_EQ(sut.poses()[0].age_ns, 0);
}

TEST(PoseDoor, keeps_the_newest_of_a_flood_and_counts_frames_that_moved)
{
    const std::vector<ObjectPose> placed{pose_of(1.0)};
    PoseDoor sut(placed, kLimit);
    for (int i = 2; i <= 1'000; ++i)
    {
        sut.put(0, pose_of(i), kStart);
    }
    sut.refresh(kStart);
    sut.refresh(kStart);
    sut.put(0, pose_of(1'000), kStart); // At rest, said again.
    sut.refresh(kStart);
    EXPECT_EQ(sut.poses()[0].scale, 1'000.0);
    EXPECT_EQ(sut.uses()[0].moves, 1U);
    EXPECT_DOUBLE_EQ(sut.uses()[0].step_max_m, (Vec3(999.0, 999.0, 999.0)).norm());
}

TEST(PoseDoor, holds_as_many_objects_as_a_frame)
{
    const std::vector<ObjectPose> placed(kMaxObjects, pose_of(1.0));
    PoseDoor sut(placed, kLimit);
    for (std::size_t i = 0; i < kMaxObjects; ++i)
    {
        sut.put(i, pose_of(static_cast<double>(i) + 10.0), kStart);
    }
    sut.refresh(kStart);
    for (std::size_t i = 0; i < kMaxObjects; ++i)
    {
        EXPECT_EQ(sut.poses()[i].scale, static_cast<double>(i) + 10.0);
    }
}

/// The writer goes on until enough different poses were seen, so that the two do meet.
TEST(PoseDoor, never_mixes_two_poses_and_never_goes_back)
{
    constexpr int kPoses = 2'000;
    const std::vector<ObjectPose> placed{pose_of(1.0)};
    PoseDoor sut(placed, kLimit);
    std::atomic<bool> reading{true};
    std::thread writer(
        [&]
        {
            for (int i = 2; reading; ++i)
            {
                sut.put(0, pose_of(i), kStart);
            }
        });
    int faults = 0;
    double last = 1.0;
    for (int seen = 0; seen < kPoses;)
    {
        sut.refresh(kStart);
        const ObjectPose& pose = sut.poses()[0];
        faults += !is_whole(pose) || pose.scale < last ? 1 : 0;
        seen += pose.scale != last ? 1 : 0;
        last = pose.scale;
    }
    reading = false;
    writer.join();
    EXPECT_EQ(faults, 0);
}

} // namespace

} // namespace tactus
