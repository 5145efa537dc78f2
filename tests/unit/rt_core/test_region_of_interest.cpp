// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/region_of_interest.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tactus::test
{

namespace
{

/// Distance to a unit sphere around the model's origin, by formula.
double to_sphere(const Vec3& point)
{
    return std::abs(point.norm() - 1.0);
}

DistanceAnswer exact_answer(double distance)
{
    DistanceAnswer answer;
    answer.kind = AnswerKind::exact;
    answer.lower_m = distance;
    answer.upper_m = distance;
    answer.certified_radius_m = distance;
    return answer;
}

/// Updates with a sphere at this position, without an approach.
void look(RegionOfInterest& sut, const Vec3& position_m, double reach_m,
          const ObjectPose& pose = {})
{
    sut.update(ToolSpec{}, {{Mat3::Identity(), position_m, 1.0}, reach_m, Vec3(0, 0, 0)}, pose);
}

} // namespace

TEST(RegionOfInterest, places_the_proxy_and_reach_in_the_models_frame)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd(0.3, Vec3(1, 1, 0).normalized()).toRotationMatrix();
    pose.translation_m = Vec3(5, 6, 7);
    pose.scale = 0.5;
    RegionOfInterest sut;

    look(sut, to_world(pose, Vec3(1, 2, 3)), 0.1, pose);

    EXPECT_NEAR((sut.core().center() - Vec3(1, 2, 3)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(sut.reach_m(), 0.2, 1e-15);
    EXPECT_FALSE(sut.is_asleep()) << "nothing is known yet";
}

TEST(RegionOfInterest, a_pair_sleeps_only_while_the_surface_is_proven_out_of_reach)
{
    Random random(80);
    int asleep = 0;
    for (int round = 0; round < 200; ++round)
    {
        RegionOfInterest sut;
        Vec3 at = random.in_cube(3.0);
        const double reach = random.between(0.01, 0.3);
        look(sut, at, reach);
        sut.remember(exact_answer(to_sphere(at)));
        for (int step = 0; step < 50; ++step)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", step " + std::to_string(step));
            at += random.in_cube(0.1);
            look(sut, at, reach);
            if (sut.is_asleep())
            {
                ++asleep;
                ASSERT_GT(to_sphere(at), reach);
            }
            const DistanceAnswer answer = sut.from_motion();
            ASSERT_LE(answer.lower_m, to_sphere(at));
            ASSERT_GE(answer.upper_m, to_sphere(at));
            ASSERT_GE(answer.lower_m, 0.0);
            ASSERT_EQ(answer.kind,
                      answer.lower_m > reach ? AnswerKind::separated : AnswerKind::bounded);
            ASSERT_TRUE(!sut.is_asleep() || answer.kind == AnswerKind::separated);
            ASSERT_LT(answer.certified_radius_m, 0.0);
        }
    }
    EXPECT_GT(asleep, 100);
}

TEST(RegionOfInterest, a_pair_wakes_when_its_proof_is_used_up)
{
    RegionOfInterest sut;
    look(sut, Vec3(3, 0, 0), 0.1);
    sut.remember(exact_answer(2.0));

    look(sut, Vec3(1.2, 0, 0), 0.1);
    EXPECT_TRUE(sut.is_asleep()) << "2 - 1.8 is beyond 1.25 x 0.1";
    look(sut, Vec3(1.12, 0, 0), 0.1);
    EXPECT_FALSE(sut.is_asleep());
    look(sut, Vec3(3, 0, 0), 1.7);
    EXPECT_FALSE(sut.is_asleep()) << "a larger reach wakes it too";
}

ObjectPose any_pose(Random& random)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd{random.between(0.0, 3.0), random.in_cube(1.0).normalized()}
                        .toRotationMatrix();
    pose.translation_m = random.in_cube(10.0);
    pose.scale = std::exp2(random.between(-5.0, 5.0));
    return pose;
}

TEST(PoseRounding, bounds_what_the_way_into_a_models_frame_and_back_is_off_by)
{
    using Exact = Eigen::Matrix<long double, 3, 1>;
    Random random(12);
    double worst = 0.0;
    for (int i = 0; i < 20'000; ++i)
    {
        const ObjectPose pose = any_pose(random);
        const Vec3 point = random.in_cube(10.0);
        const Vec3 back = to_world(pose, to_model(pose, point));
        const Exact off = back.cast<long double>() - point.cast<long double>();
        worst =
            std::max(worst, static_cast<double>(off.norm()) / pose_rounding_m(pose, point, 0.0));
    }
    EXPECT_LE(worst, 1.0) << "of kPoseRounding, " << kPoseRounding;
    EXPECT_GT(worst, 0.05) << "a bound so wide says nothing";
}

TEST(PoseRounding, bounds_what_a_models_place_is_off_by_because_its_pose_is_its_sources)
{
    using Exact = Eigen::Matrix<long double, 3, 1>;
    Random random(13);
    double worst = 0.0;
    for (int i = 0; i < 20'000; ++i)
    {
        ObjectPose pose = any_pose(random);
        const Vec3 origin = random.in_cube(1e6);
        pose.translation_m = -pose.scale * (pose.rotation * origin); // Back to the hand's position.
        const Exact place =
            pose.translation_m.cast<long double>() +
            pose.scale * (pose.rotation.cast<long double>() * origin.cast<long double>());
        const Exact off = model_pose(pose, origin).translation_m.cast<long double>() - place;
        worst = std::max(worst, static_cast<double>(off.norm()) /
                                    (kOriginRounding * origin.norm() * pose.scale));
    }
    EXPECT_LE(worst, 1.0);
    EXPECT_GT(worst, 0.05) << "a bound so wide says nothing";
}

} // namespace tactus::test
