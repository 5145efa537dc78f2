// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"
#include "platform/scene/scene_parts.hpp"
#include "tests/shared/frame_rig.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tactus::hrtc
{

namespace
{

constexpr std::uint64_t kSeed = 20'260'731;

/// Quaternion of length 1 except for rounding, or with the greatest deviation of a valid pose.
Pose random_pose(std::mt19937_64& random, double length)
{
    std::normal_distribution<double> number;
    Eigen::Vector4d q{number(random), number(random), number(random), number(random)};
    q *= length / q.norm();
    Pose pose;
    pose.rotation = {q[0], q[1], q[2], q[3]};
    pose.translation_m = {number(random), number(random), number(random)};
    pose.scale = std::exp(number(random));
    return pose;
}

TEST(ObjectPose, a_quaternion_becomes_the_rotation_that_it_is_and_stays_orthonormal)
{
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 100'000; ++i)
    {
        const Pose pose = random_pose(random, i % 2 == 0 ? 1.0 : 1.0 + kPoseUnitTolerance);
        const Mat3 rotation = to_similarity(pose).rotation;
        const auto& q = pose.rotation;
        const Mat3 oracle = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().matrix();
        ASSERT_LT((rotation - oracle).cwiseAbs().maxCoeff(), 2e-15) << "seed " << kSeed << " " << i;
        const Mat3 excess = rotation.transpose() * rotation - Mat3::Identity();
        ASSERT_LT(excess.cwiseAbs().maxCoeff(), 2e-15) << "seed " << kSeed << " " << i;
    }
}

TEST(ObjectPose, from_a_server_is_where_place_would_put_the_object)
{
    const tactus::test::TestModel& model = tactus::test::small_model(0);
    const tactus::test::FrameRig rig(model, tactus::test::with_room_for_all());
    const ModelHeader& header = rig.frame().model({0}).header;
    const auto placement = parse_placement("0.1,-0.2,0.3,0,0,90,2");
    ASSERT_TRUE(placement);
    Pose pose;
    pose.translation_m = {0.1, -0.2, 0.3};
    pose.rotation = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
    pose.scale = 2.0;
    const ObjectPose placed = object_pose(placement.value(), header);
    const ObjectPose moved = object_pose(to_similarity(pose), header);
    EXPECT_LT((placed.rotation - moved.rotation).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((placed.translation_m - moved.translation_m).norm(), 1e-15);
    EXPECT_EQ(placed.scale, moved.scale);
    EXPECT_EQ(placed.revision, moved.revision);
    // Quarter turn about z of the source's point (1, 0, 0).
    const Vec3 world_m = to_world(moved, Vec3(1.0, 0.0, 0.0));
    EXPECT_LT((world_m - Vec3(0.1, -0.2 + 2.0, 0.3)).norm(), 1e-14);
}

} // namespace

} // namespace tactus::hrtc
