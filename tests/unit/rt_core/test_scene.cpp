// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/scene.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

namespace
{

/// The distance to a unit sphere round the model's origin: truth by formula.
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

} // namespace

TEST(Scene, makes_a_pair_of_each_tool_and_object_tool_by_tool)
{
    const std::array<ToolSpec, kMaxTools> tools{};
    const std::array<ObjectSpec, kMaxObjects> objects{};

    Scene full(tools, objects);
    Scene one{std::span(tools).first(1), std::span(objects).first(1)};
    Scene none({}, {});

    ASSERT_EQ(full.pairs().size(), kMaxPairs);
    EXPECT_EQ(full.pairs()[kMaxObjects + 2].tool, 1U);
    EXPECT_EQ(full.pairs()[kMaxObjects + 2].object, 2U);
    EXPECT_EQ(one.pairs().size(), 1U);
    EXPECT_TRUE(none.pairs().empty());
}

TEST(Scene, more_tools_than_allowed_are_a_bug)
{
    const std::array<ToolSpec, kMaxTools + 1> tools{};
    EXPECT_DEATH(Scene(tools, {}), "");
}

Scene ball_scene()
{
    const std::array<ToolSpec, 1> tools{};
    const std::array<ObjectSpec, 1> objects{};
    return {tools, objects};
}

TEST(Scene, places_the_proxy_and_reach_in_the_models_frame)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd(0.3, Vec3(1, 1, 0).normalized()).toRotationMatrix();
    pose.translation_m = Vec3(5, 6, 7);
    pose.scale = 0.5;
    const Scene scene = ball_scene();
    ScenePair pair;

    scene.place(pair, pose, Mat3::Identity(), to_world(pose, Vec3(1, 2, 3)), 0.1, Vec3(0, 0, 0));

    EXPECT_NEAR((pair.core.center() - Vec3(1, 2, 3)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(pair.reach_m, 0.2, 1e-15);
    EXPECT_FALSE(pair.is_asleep) << "nothing is known yet";
}

TEST(Scene, a_pair_sleeps_only_while_the_surface_is_proven_out_of_reach)
{
    Random random(80);
    const Scene scene = ball_scene();
    const ObjectPose pose;
    int asleep = 0;
    for (int round = 0; round < 200; ++round)
    {
        ScenePair pair;
        Vec3 at = random.in_cube(3.0);
        const double reach = random.between(0.01, 0.3);
        scene.place(pair, pose, Mat3::Identity(), at, reach, Vec3(0, 0, 0));
        Scene::remember(pair, exact_answer(to_sphere(at)));
        for (int step = 0; step < 50; ++step)
        {
            at += random.in_cube(0.1);
            scene.place(pair, pose, Mat3::Identity(), at, reach, Vec3(0, 0, 0));
            if (pair.is_asleep)
            {
                ++asleep;
                ASSERT_GT(to_sphere(at), reach);
            }
            const DistanceAnswer answer = Scene::from_motion(pair);
            ASSERT_LE(answer.lower_m, to_sphere(at));
            ASSERT_GE(answer.upper_m, to_sphere(at));
            ASSERT_GE(answer.lower_m, 0.0);
            ASSERT_EQ(answer.kind,
                      answer.lower_m > reach ? AnswerKind::decided : AnswerKind::bracket);
            ASSERT_TRUE(!pair.is_asleep || answer.kind == AnswerKind::decided);
            ASSERT_LT(answer.certified_radius_m, 0.0);
        }
    }
    EXPECT_GT(asleep, 100);
}

TEST(Scene, a_pair_wakes_when_its_proof_is_used_up)
{
    const Scene scene = ball_scene();
    const ObjectPose pose;
    ScenePair pair;
    scene.place(pair, pose, Mat3::Identity(), Vec3(3, 0, 0), 0.1, Vec3(0, 0, 0));
    Scene::remember(pair, exact_answer(2.0));

    scene.place(pair, pose, Mat3::Identity(), Vec3(1.2, 0, 0), 0.1, Vec3(0, 0, 0));
    EXPECT_TRUE(pair.is_asleep) << "2 - 1.8 is beyond 1.25 x 0.1";
    scene.place(pair, pose, Mat3::Identity(), Vec3(1.12, 0, 0), 0.1, Vec3(0, 0, 0));
    EXPECT_FALSE(pair.is_asleep);
    scene.place(pair, pose, Mat3::Identity(), Vec3(3, 0, 0), 1.7, Vec3(0, 0, 0));
    EXPECT_FALSE(pair.is_asleep) << "a larger reach wakes it too";
}

TEST(ObjectPose, to_world_undoes_to_model)
{
    Random random(81);
    for (int i = 0; i < 1'000; ++i)
    {
        ObjectPose pose;
        pose.rotation = Eigen::AngleAxisd(random.between(-3, 3), random.in_cube(1.0).normalized())
                            .toRotationMatrix();
        pose.translation_m = random.in_cube(10.0);
        pose.scale = std::exp2(random.between(-5.0, 5.0));
        const Vec3 point = random.in_cube(1.0);
        ASSERT_NEAR((to_model(pose, to_world(pose, point)) - point).norm(), 0.0, 1e-11);
    }
}

} // namespace tactus::test
