// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/owned_surface.hpp"
#include "tests/unit/rt_core/surface_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Of the listed faces, as seen from the place; the nearest one's bound.
double nearest_seen(Vicinity& sut, const Vec3& place)
{
    sut.stand_at(place - sut.center_m(), Vec3(0, 0, 1));
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t face = 0; face < sut.size(); ++face)
    {
        const HalfSpace<3> plane = sut.half_space(face, 0.0);
        least = std::min(least, -plane.offset);
    }
    return least;
}

} // namespace

TEST(Vicinity, of_nothing_lets_everything_go)
{
    Vicinity sut({}, Vec3(0, 0, 0), Vec3(0, 0, 0), 1.0);

    EXPECT_EQ(sut.size(), 0U);
    EXPECT_EQ(sut.reach_m(), 1.0);
    EXPECT_FALSE(sut.find_entered(Vec3(1, 2, 3), 0.1).has_value());
    EXPECT_EQ(sut.free_share(Vec3(1, 2, 3), 0.1), 1.0);
    EXPECT_TRUE(std::isinf(sut.bound_of_surface(0, Vec3(0, 0, 0))));
}

TEST(Vicinity, lists_the_triangles_within_its_reach)
{
    Random random(60);
    const TriangleList list = scattered(random, 200);
    const ObjectPose pose;
    const Material material;
    const Vec3 anchor = random.in_cube(0.1);
    const auto surface = surface_of(list, anchor, 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    for (int i = 0; i < 300; ++i)
    {
        const Vec3 center = random.in_cube(1.0);
        const double reach = random.between(0.1, 0.6);
        Vicinity sut({&placed, 1}, anchor, center, reach);
        ASSERT_EQ(sut.reach_m(), reach);
        const Vec3 point = center + random.in_cube(0.05);
        const double truth = distance_to(list, point);
        const double seen = nearest_seen(sut, point);
        const double unlisted = reach - (point - center).norm();
        ASSERT_GE(seen, truth - 1e-12);
        if (truth < unlisted)
        {
            ASSERT_NEAR(seen, truth, 1e-12);
        }
    }
}

TEST(Vicinity, a_bound_is_never_more_than_the_distance_wherever_it_was_seen_from)
{
    Random random(61);
    const ObjectPose pose = turned();
    const Material material;
    for (int i = 0; i < 2'000; ++i)
    {
        const TriangleList list = scattered(random, 1);
        const Vec3 center = to_world(pose, random.in_cube(1.0));
        const auto surface = surface_of(list, to_model(pose, center), 10.0);
        const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        Vicinity sut({&placed, 1}, center, center, 10.0);
        ASSERT_EQ(sut.size(), 1U);
        for (int look = 0; look < 3; ++look)
        {
            for (int k = 0; k < 10; ++k)
            {
                const Vec3 place = random.in_cube(2.0);
                const double truth = pose.scale * distance_to(list, to_model(pose, center + place));
                ASSERT_LE(sut.bound(0, place), truth + 1e-12);
                ASSERT_LE(sut.bound_of_surface(0, place), truth + 1e-12);
            }
            sut.stand_at(random.in_cube(1.0), Vec3(0, 0, 1));
            ASSERT_NEAR(sut.half_space(0, 0.0).normal.norm(), 1.0, 1e-12);
        }
    }
}

TEST(Vicinity, a_motion_enters_nothing_that_it_does_not_name)
{
    Random random(63);
    const ObjectPose pose;
    const Material material;
    int named = 0;
    for (int i = 0; i < 2'000; ++i)
    {
        const TriangleList list = scattered(random, 60);
        const Vec3 center = random.in_cube(0.5);
        const double truth = distance_to(list, center);
        const double radius = truth * random.between(0.1, 1.0);
        const auto surface = surface_of(list, center, 10.0);
        const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        Vicinity sut({&placed, 1}, center, center, 10.0);
        const Vec3 motion = random.in_cube(0.2);
        const auto entered = sut.find_entered(motion, radius);
        const double share = sut.free_share(motion, radius);
        for (int k = 0; k <= 20; ++k)
        {
            const Vec3 at = center + motion * (share * k / 20.0);
            ASSERT_GE(distance_to(list, at), radius * (1.0 - 1e-5));
        }
        ASSERT_EQ(entered.has_value(), share < 1.0);
        named += entered ? 1 : 0;
        if (entered)
        {
            const HalfSpace<3> plane = sut.half_space(*entered, radius);
            ASSERT_LE(plane.offset, 1e-12); // To stand still is allowed, the motion is not:
            ASSERT_LT(plane.normal.dot(motion), plane.offset);
        }
    }
    EXPECT_GT(named, 200);
    EXPECT_LT(named, 1'800);
}

TEST(Vicinity, distances_are_the_worlds_under_pose_and_scale)
{
    const ObjectPose pose = turned();
    const Material material;
    const auto surface = surface_of(plane(), Vec3(0, 0, 0.1), 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    const Vec3 point = pose.translation_m + Vec3(0.05, 0.1, 0.6);
    Vicinity sut({&placed, 1}, to_world(pose, Vec3(0, 0, 0.1)), point, 5.0);
    sut.stand_at(Vec3(0, 0, 0), Vec3(1, 0, 0));

    ASSERT_EQ(sut.size(), 2U); // One of the two is straight below.
    const HalfSpace<3> first = sut.half_space(0, 0.1);
    const HalfSpace<3> second = sut.half_space(1, 0.1);
    const HalfSpace<3>& nearer = first.offset > second.offset ? first : second;
    EXPECT_NEAR(nearer.offset, 0.1 - 0.6, 1e-12);
    EXPECT_NEAR((nearer.normal - Vec3(0, 0, 1)).norm(), 0.0, 1e-12);
}

TEST(Vicinity, says_how_far_it_reaches_when_more_triangles_are_near_than_fit)
{
    Random random(62);
    for (int round = 0; round < 20; ++round)
    {
        const std::array<TriangleList, 2> lists{scattered(random, 450), scattered(random, 450)};
        const ObjectPose pose;
        const Material material;
        const Vec3 center = random.in_cube(0.5);
        const auto first = surface_of(lists[0], center, 10.0);
        const auto second = surface_of(lists[1], center, 10.0);
        const std::array<PlacedSurface, 2> placed{
            {{&pose, first.get(), &material, 1e-6}, {&pose, second.get(), &material, 1e-6}}};

        Vicinity sut(placed, center, center, 10.0);

        ASSERT_LT(sut.reach_m(), 10.0);
        ASSERT_GT(sut.size(), 50U);
        for (int i = 0; i < 20; ++i)
        {
            const Vec3 point = center + random.in_cube(0.2);
            const double truth =
                std::min(distance_to(lists[0], point), distance_to(lists[1], point));
            const double seen = nearest_seen(sut, point);
            const double unlisted = sut.reach_m() - (point - center).norm();
            ASSERT_GE(seen, truth - 1e-12);
            ASSERT_GE(truth, std::min(seen, unlisted) - 1e-12);
        }
    }
}

TEST(Vicinity, of_more_equally_near_triangles_than_fit_lets_nothing_move)
{
    const TriangleList many(kMaxNearFaces + 1, plane().front());
    const ObjectPose pose;
    const Material material;
    const auto surface = surface_of(many, Vec3(0.2, 0.1, 0.05), 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    const Vec3 center(0.2, 0.1, 0.05);

    const Vicinity sut({&placed, 1}, center, center, 1.0);

    EXPECT_LE(sut.reach_m(), 0.05);
}

TEST(Vicinity, reaches_as_far_as_asked_with_as_many_triangles_as_fit)
{
    const ObjectPose pose;
    const Material material;
    const Vec3 center(0.2, 0.1, 0.05);
    for (const std::uint32_t count : {kMaxNearFaces, kMaxNearFaces + 1})
    {
        const TriangleList many(count, plane().front());
        const auto surface = surface_of(many, center, 10.0);
        const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        const Vicinity sut({&placed, 1}, center, center, 1.0);
        EXPECT_EQ(sut.reach_m() == 1.0, count == kMaxNearFaces);
    }
}

TEST(Vicinity, halves_what_it_reaches_beyond_the_nearest_so_many_times_and_no_more)
{
    constexpr double kNearest = 0.125;
    const double last = kNearest + std::ldexp(1.0, -kMaxGatherings);
    for (const double share : {0.9, 1.1})
    {
        // One face at a time in reach of the last list, or all of them.
        const double far = kNearest + share * std::ldexp(1.0, -kMaxGatherings);
        OwnedSurface surface;
        surface.distances_m[surface.count++] = kNearest;
        while (surface.count <= kMaxNearFaces)
        {
            surface.distances_m[surface.count++] = far;
        }
        const ObjectPose pose;
        const Material material;
        const PlacedSurface placed{&pose, &surface, &material, 1e-6};

        const Vicinity sut({&placed, 1}, Vec3(0, 0, 0), Vec3(0, 0, 0), kNearest + 1.0);

        EXPECT_EQ(sut.size(), 1U);
        EXPECT_EQ(sut.reach_m(), share > 1.0 ? last : kNearest);
    }
}

TEST(Vicinity, a_face_is_entered_by_more_than_the_tolerance)
{
    const ObjectPose pose;
    const Material material;
    const double radius = 0.01;
    const Vec3 center(0.25, 0.1, radius);
    const auto surface = surface_of(plane(), center, 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    for (const double share : {0.9, 1.1})
    {
        Vicinity sut({&placed, 1}, center, center, 1.0);
        sut.stand_at(Vec3(0, 0, 0), Vec3(0, 0, 1));
        const Vec3 motion(0, 0, -share * kContactTolerance * radius);
        EXPECT_EQ(sut.find_entered(motion, radius).has_value(), share > 1.0);
    }
}

TEST(Vicinity, a_place_on_the_surface_sees_it_along_the_fallback)
{
    const ObjectPose pose;
    const Material material;
    const auto surface = surface_of(plane(), Vec3(0, 0, 0), 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    Vicinity sut({&placed, 1}, Vec3(0, 0, 0), Vec3(0, 0, 0), 1.0);
    sut.stand_at(Vec3(0.25, 0.1, 0), Vec3(0, 0, -1));

    const HalfSpace<3> plane_there = sut.half_space(0, 0.1);

    EXPECT_EQ(plane_there.normal, Vec3(0, 0, -1));
    EXPECT_NEAR(plane_there.offset, 0.1, 1e-15);
}

} // namespace tactus::test
