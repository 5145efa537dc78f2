// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/rt_core/surface_support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

namespace
{

TriangleList scattered(Random& random, std::uint32_t count)
{
    TriangleList list;
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const Vec3 at = random.in_cube(1.0);
        list.push_back({to_float(at), to_float(at + random.in_cube(0.05)),
                        to_float(at + random.in_cube(0.05))});
    }
    return list;
}

ObjectPose turned()
{
    ObjectPose pose;
    pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    pose.translation_m = Vec3(0.1, 0.2, 0.3);
    pose.scale = 2.0;
    return pose;
}

} // namespace

TEST(Vicinity, of_nothing_is_infinitely_far_with_the_fallback_normal)
{
    const Vicinity sut({}, Vec3(0, 0, 0), 1.0, false);

    const NearestSurface near = sut.nearest(Vec3(0, 0, 0), Vec3(0, 1, 0));

    EXPECT_TRUE(std::isinf(near.distance_m));
    EXPECT_EQ(near.normal, Vec3(0, 1, 0));
    EXPECT_EQ(sut.reach_m(), 1.0);
}

TEST(Vicinity, finds_the_nearest_triangle_within_its_reach)
{
    Random random(60);
    const TriangleList list = scattered(random, 200);
    const ObjectPose pose;
    const auto surface = surface_of(list, Vec3(0, 0, 0), 10.0);
    const PlacedSurface placed{&pose, surface.get()};
    for (int i = 0; i < 300; ++i)
    {
        const Vec3 center = random.in_cube(1.0);
        const double reach = random.between(0.1, 0.6);
        const Vicinity sut({&placed, 1}, center, reach, false);
        const Vec3 point = center + random.in_cube(0.05);
        const double truth = distance_to(list, point);
        const NearestSurface near = sut.nearest(point, Vec3(0, 0, 1));
        ASSERT_EQ(sut.reach_m(), reach);
        const double unlisted = reach - (point - center).norm();
        if (truth < unlisted)
        {
            ASSERT_NEAR(near.distance_m, truth, 1e-12);
            ASSERT_NEAR(near.normal.norm(), 1.0, 1e-12);
            // A step along the normal leads to the surface and away from it.
            ASSERT_NEAR(distance_to(list, point - near.normal * truth), 0.0, 1e-9);
        }
        else
        {
            ASSERT_GE(near.distance_m, truth - 1e-12);
        }
    }
}

TEST(Vicinity, at_the_query_centre_uses_the_distances_that_are_known)
{
    Random random(61);
    const TriangleList list = scattered(random, 200);
    const ObjectPose pose = turned();
    const Vec3 center(0.4, -0.1, 0.2);
    const auto surface = surface_of(list, to_model(pose, center), 10.0);
    const PlacedSurface placed{&pose, surface.get()};

    const Vicinity known({&placed, 1}, center, 0.8, true);
    const Vicinity computed({&placed, 1}, center, 0.8, false);

    for (int i = 0; i < 100; ++i)
    {
        const Vec3 point = center + random.in_cube(0.3);
        EXPECT_EQ(known.nearest(point, Vec3(0, 0, 1)).distance_m,
                  computed.nearest(point, Vec3(0, 0, 1)).distance_m);
    }
}

TEST(Vicinity, distances_are_the_worlds_under_pose_and_scale)
{
    const ObjectPose pose = turned();
    const auto surface = surface_of(plane(), Vec3(0, 0, 0.1), 10.0);
    const PlacedSurface placed{&pose, surface.get()};

    const Vec3 point = pose.translation_m + Vec3(0.05, 0.1, 0.6);
    const Vicinity sut({&placed, 1}, point, 5.0, false);
    const NearestSurface near = sut.nearest(point, Vec3(1, 0, 0));

    EXPECT_NEAR(near.distance_m, 0.6, 1e-12);
    EXPECT_NEAR((near.normal - Vec3(0, 0, 1)).norm(), 0.0, 1e-12);
}

TEST(Vicinity, says_how_far_it_reaches_when_more_triangles_are_near_than_fit)
{
    Random random(62);
    for (int round = 0; round < 20; ++round)
    {
        const std::array<TriangleList, 2> lists{scattered(random, 250), scattered(random, 250)};
        const ObjectPose pose;
        const Vec3 center = random.in_cube(0.5);
        const auto first = surface_of(lists[0], center, 10.0);
        const auto second = surface_of(lists[1], center, 10.0);
        const std::array<PlacedSurface, 2> placed{{{&pose, first.get()}, {&pose, second.get()}}};

        const Vicinity sut(placed, center, 10.0, true);

        ASSERT_LT(sut.reach_m(), 10.0);
        for (int i = 0; i < 20; ++i)
        {
            const Vec3 point = center + random.in_cube(0.2);
            const double truth =
                std::min(distance_to(lists[0], point), distance_to(lists[1], point));
            const double found = sut.nearest(point, Vec3(0, 0, 1)).distance_m;
            const double unlisted = sut.reach_m() - (point - center).norm();
            ASSERT_GE(found, truth - 1e-12);
            ASSERT_GE(truth, std::min(found, unlisted) - 1e-12);
        }
    }
}

TEST(Vicinity, a_point_on_the_surface_gets_the_fallback_normal)
{
    const ObjectPose pose;
    const auto surface = surface_of(plane(), Vec3(0, 0, 0), 10.0);
    const PlacedSurface placed{&pose, surface.get()};
    const Vicinity sut({&placed, 1}, Vec3(0, 0, 0), 1.0, true);

    const NearestSurface near = sut.nearest(Vec3(0.25, 0.1, 0), Vec3(0, 0, 1));

    EXPECT_EQ(near.distance_m, 0.0);
    EXPECT_EQ(near.normal, Vec3(0, 0, 1));
}

} // namespace tactus::test
