// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/vicinity.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/unit/rt_core/surface_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

std::uint32_t count_of(const Vicinity& sut)
{
    std::uint32_t count = 0;
    for (std::uint32_t face = 0; face < sut.size(); ++face)
    {
        count += sut.has(face) ? 1U : 0U;
    }
    return count;
}

/// Checks all faces of some surfaces, listed with all sets of kernels.
void with_each_set(PlacedSurface placed, const auto& check)
{
    for (const Kernels* kernels : available_kernels())
    {
        placed.kernels = kernels;
        check(placed);
    }
}

/// Bound of the nearest listed face, seen from the place.
double nearest_seen(Vicinity& sut, const Vec3& place)
{
    sut.stand_at(place - sut.center_m(), Vec3(0, 0, 1));
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t face = 0; face < sut.size(); ++face)
    {
        least = sut.has(face) ? std::min(least, -sut.half_space(face, 0.0).offset) : least;
    }
    return least;
}

} // namespace

TEST(Vicinity, of_nothing_lets_everything_go)
{
    Vicinity sut({}, Vec3(0, 0, 0), 1.0);

    EXPECT_EQ(sut.size(), 0U);
    EXPECT_EQ(sut.reach_m(), 1.0);
    EXPECT_FALSE(sut.find_entered(Vec3(1, 2, 3), 0.1).has_value());
    EXPECT_FALSE(sut.find_entered(Vec3(1, 2, 3), 0.0).has_value()) << "a point without a skin";
    EXPECT_EQ(sut.free_share(Vec3(1, 2, 3), 0.1), 1.0);
    EXPECT_TRUE(std::isinf(sut.bound_of_surface(0, Vec3(0, 0, 0))));
}

TEST(Vicinity, lists_the_triangles_of_its_surfaces)
{
    Random random(60);
    const ObjectPose pose;
    const Material material;
    for (int i = 0; i < 300; ++i)
    {
        SCOPED_TRACE(i);
        const TriangleList list = scattered(random, 1 + random.below(200));
        const Vec3 center = random.in_cube(1.0);
        const auto surface = surface_of(list, center, 10.0);
        const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        Vicinity sut({&placed, 1}, center, 10.0);
        ASSERT_EQ(sut.reach_m(), 10.0);
        ASSERT_EQ(count_of(sut), list.size());
        const Vec3 point = center + random.in_cube(0.5);
        ASSERT_NEAR(nearest_seen(sut, point), distance_to(list, point), 1e-12);
    }
}

TEST(Vicinity, lists_what_is_within_a_distance_of_here_in_order_and_says_when_some_has_no_room)
{
    Random random(64);
    const ObjectPose pose = turned();
    const Material material;
    for (int i = 0; i < 300; ++i)
    {
        SCOPED_TRACE(i);
        const TriangleList list = scattered(random, 100);
        const Vec3 center = to_world(pose, random.in_cube(0.5));
        const auto surface = surface_of(list, to_model(pose, center), 10.0);
        with_each_set({&pose, surface.get(), &material, 1e-6},
                      [&](const PlacedSurface& placed)
                      {
                          Vicinity sut({&placed, 1}, center, 10.0);
                          const Vec3 place = random.in_cube(0.5);
                          sut.stand_at(place, Vec3(0, 0, 1));
                          const double distance = random.between(0.1, 1.5);
                          std::array<std::uint32_t, 5> faces{};
                          const Vicinity::Listed listed = sut.list_within(distance, faces);
                          std::vector<std::uint32_t> expected;
                          for (std::uint32_t face = 0; face < list.size(); ++face)
                          {
                              const double truth =
                                  pose.scale *
                                  distance_to({list[face]}, to_model(pose, center + place));
                              ASSERT_GT(std::abs(truth - distance), 1e-12);
                              if (truth <= distance)
                              {
                                  expected.push_back(face);
                              }
                          }
                          ASSERT_EQ(listed.is_all, expected.size() <= faces.size());
                          ASSERT_EQ(listed.count, std::min(expected.size(), faces.size()));
                          expected.resize(listed.count);
                          for (std::size_t k = 0; k < expected.size(); ++k)
                          {
                              ASSERT_EQ(faces[k], expected[k]);
                          }
                      });
    }
}

TEST(Vicinity, a_bound_is_never_more_than_the_distance_wherever_it_was_seen_from)
{
    Random random(61);
    const ObjectPose pose = turned();
    const Material material;
    for (int i = 0; i < 2'000; ++i)
    {
        SCOPED_TRACE(i);
        const TriangleList list = scattered(random, 1);
        const Vec3 center = to_world(pose, random.in_cube(1.0));
        const auto surface = surface_of(list, to_model(pose, center), 10.0);
        const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        Vicinity sut({&placed, 1}, center, 10.0);
        ASSERT_EQ(count_of(sut), 1U);
        for (int look = 0; look < 3; ++look)
        {
            for (int k = 0; k < 10; ++k)
            {
                const Vec3 place = random.in_cube(2.0);
                const double truth = pose.scale * distance_to(list, to_model(pose, center + place));
                ASSERT_LE(sut.bound_of_surface(0, place), truth + 1e-12);
            }
            sut.stand_at(random.in_cube(1.0), Vec3(0, 0, 1));
            static_cast<void>(sut.find_entered(random.in_cube(1.0), 0.5));
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
        SCOPED_TRACE(i);
        const TriangleList list = scattered(random, 60);
        const Vec3 center = random.in_cube(0.5);
        const double truth = distance_to(list, center);
        const double radius = truth * random.between(0.1, 1.0);
        const auto surface = surface_of(list, center, 10.0);
        PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        placed.kernels = available_kernels()[random.below(
            static_cast<std::uint32_t>(available_kernels().size()))];
        Vicinity sut({&placed, 1}, center, 10.0);
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
            ASSERT_LE(plane.offset, 1e-12); // Resting is allowed, the motion is not.
            ASSERT_LT(plane.normal.dot(motion), plane.offset);
        }
    }
    EXPECT_GT(named, 200);
    EXPECT_LT(named, 1'800);
}

TEST(Vicinity, with_any_allowance_and_however_deep_the_sphere_is_lets_it_come_no_nearer)
{
    Random random(65);
    const ObjectPose pose = turned();
    const Material material;
    int spent = 0;
    int deep = 0;
    int went = 0;
    for (int i = 0; i < 2'000; ++i)
    {
        const TriangleList list = scattered(random, 60);
        const Vec3 center = random.in_cube(0.5);
        const double truth = pose.scale * distance_to(list, to_model(pose, center));
        const double radius = truth * random.between(0.2, 3.0);
        const auto surface = surface_of(list, to_model(pose, center), 10.0);
        PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        placed.kernels = available_kernels()[random.below(available_kernels().size())];
        const std::uint32_t planes = random.one_in(4) ? Vicinity::kUnlimited : random.below(40U);
        Vicinity sut({&placed, 1}, center, 10.0, planes);
        sut.stand_at(Vec3(0, 0, 0), Vec3(0, 0, 1));
        std::array<std::uint32_t, 64> faces{};
        static_cast<void>(sut.list_within(radius * 1.001, faces));
        const Vec3 motion = random.in_cube(0.4);
        static_cast<void>(sut.find_entered(motion, radius));
        const double share = sut.free_share(motion, radius);
        const double least = std::min(radius, truth) * (1.0 - 1e-5);
        for (int k = 0; k <= 20; ++k)
        {
            const Vec3 at = center + motion * (share * k / 20.0);
            ASSERT_GE(pose.scale * distance_to(list, to_model(pose, at)), least) << i;
        }
        ASSERT_LE(sut.planes_left(), planes);
        spent += sut.is_spent() ? 1 : 0;
        deep += radius > truth ? 1 : 0;
        went += sut.is_spent() && share > 0.0 ? 1 : 0;
    }
    EXPECT_GT(spent, 100);
    EXPECT_GT(deep, 500);
    EXPECT_GT(went, 50) << "what is proven must not be given up";
}

TEST(Vicinity, among_many_that_touch_looks_at_a_bounded_number_of_them)
{
    // All are equally far, so that single precision cannot decide which of them touch.
    const TriangleList list(2 * kMaxTouchLooks, plane().front());
    const ObjectPose pose;
    const Material material;
    const auto surface = surface_of(list, Vec3(0.5, 0, 1), 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    const std::uint32_t planes = 4 * kMaxTouchLooks;
    Vicinity sut({&placed, 1}, Vec3(0.5, 0, 1), 10.0, planes);
    sut.stand_at(Vec3(0, 0, 0), Vec3(0, 0, 1));
    std::vector<std::uint32_t> faces(list.size());
    const Vicinity::Listed touching = sut.list_within(1.0, faces);
    EXPECT_EQ(touching.count, kMaxTouchLooks);
    EXPECT_FALSE(touching.is_all);
    EXPECT_LE(planes - sut.planes_left(), kMaxTouchLooks + list.size() / kPlaneLanes);
    EXPECT_EQ(sut.list_within(0.5, faces).count, 0U);
    EXPECT_TRUE(sut.list_within(0.5, faces).is_all);
}

TEST(Vicinity, distances_are_the_worlds_under_pose_and_scale)
{
    const ObjectPose pose = turned();
    const Material material;
    const auto surface = surface_of(plane(), Vec3(0, 0, 0.1), 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    const Vec3 point = pose.translation_m + Vec3(0.05, 0.1, 0.6);
    const Vec3 center = to_world(pose, Vec3(0, 0, 0.1));
    Vicinity sut({&placed, 1}, center, 5.0);
    sut.stand_at(point - center, Vec3(1, 0, 0));

    ASSERT_EQ(count_of(sut), 2U); // One of the two is straight below.
    const HalfSpace<3> first = sut.half_space(0, 0.1);
    const HalfSpace<3> second = sut.half_space(1, 0.1);
    const HalfSpace<3>& nearer = first.offset > second.offset ? first : second;
    EXPECT_NEAR(nearer.offset, 0.1 - 0.6, 1e-12);
    EXPECT_NEAR((nearer.normal - Vec3(0, 0, 1)).norm(), 0.0, 1e-12);
}

TEST(Vicinity, of_several_surfaces_lists_the_nearest_and_says_how_far_it_reaches)
{
    Random random(62);
    const ObjectPose pose;
    const Material material;
    for (int round = 0; round < 20; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        const Vec3 center = random.in_cube(0.5);
        std::vector<TriangleList> lists;
        std::vector<std::unique_ptr<OwnedSurface>> surfaces;
        std::vector<PlacedSurface> placed;
        for (int i = 0; i < 4; ++i)
        {
            lists.push_back(scattered(random, 300 + random.below(500)));
            surfaces.push_back(surface_of(lists.back(), center, 10.0));
            placed.push_back({&pose, surfaces.back().get(), &material, 1e-6});
        }
        Vicinity sut(placed, center, 10.0);

        ASSERT_LT(sut.reach_m(), 10.0);
        ASSERT_GT(count_of(sut), 7U * (kMaxNearBatches - 1));
        for (int i = 0; i < 20; ++i)
        {
            const Vec3 point = center + random.in_cube(0.2);
            double truth = std::numeric_limits<double>::infinity();
            for (const TriangleList& list : lists)
            {
                truth = std::min(truth, distance_to(list, point));
            }
            const double seen = nearest_seen(sut, point);
            const double unlisted = sut.reach_m() - (point - center).norm();
            ASSERT_GE(seen, truth - 1e-12);
            ASSERT_GE(truth, std::min(seen, unlisted) - 1e-12);
        }
    }
}

TEST(Vicinity, of_more_equally_near_triangles_than_fit_lets_nothing_come_nearer)
{
    const TriangleList many(kMaxLocalTriangles, plane().front());
    const ObjectPose pose;
    const Material material;
    const Vec3 center(0.2, 0.1, 0.05);
    const auto surface = surface_of(many, center, 10.0);
    const std::array<PlacedSurface, 2> placed{
        {{&pose, surface.get(), &material, 1e-6}, {&pose, surface.get(), &material, 1e-6}}};

    const Vicinity sut(placed, center, 1.0);

    EXPECT_LE(sut.reach_m(), 0.05);
    EXPECT_GT(sut.reach_m(), 0.049);
}

TEST(Vicinity, reaches_as_far_as_asked_with_as_many_batches_as_fit)
{
    const ObjectPose pose;
    const Material material;
    const Vec3 center(0.2, 0.1, 0.05);
    const auto first = surface_of(TriangleList(kMaxLocalTriangles, plane().front()), center, 10.0);
    for (const std::uint32_t more : {0U, 1U})
    {
        const std::uint32_t count = kPlaneLanes * kMaxNearBatches - kMaxLocalTriangles + more;
        const auto second = surface_of(TriangleList(count, plane().front()), center, 10.0);
        const std::array<PlacedSurface, 2> placed{
            {{&pose, first.get(), &material, 1e-6}, {&pose, second.get(), &material, 1e-6}}};
        const Vicinity sut(placed, center, 1.0);
        EXPECT_EQ(sut.reach_m() == 1.0, more == 0U);
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
        Vicinity sut({&placed, 1}, center, 1.0);
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
    Vicinity sut({&placed, 1}, Vec3(0, 0, 0), 1.0);
    sut.stand_at(Vec3(0.25, 0.1, 0), Vec3(0, 0, -1));

    const HalfSpace<3> plane_there = sut.half_space(0, 0.1);

    EXPECT_EQ(plane_there.normal, Vec3(0, 0, -1));
    EXPECT_NEAR(plane_there.offset, 0.1, 1e-15);
}

TEST(Vicinity, knows_how_far_a_way_is_free_of_a_face)
{
    Random random(65);
    const ObjectPose pose = turned();
    const Material material;
    int touched = 0;
    for (int i = 0; i < 2'000; ++i)
    {
        const TriangleList list = scattered(random, 1);
        const Vec3 center = to_world(pose, random.in_cube(0.5));
        const auto surface = surface_of(list, to_model(pose, center), 10.0);
        const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
        Vicinity sut({&placed, 1}, center, 10.0);
        const auto distance = [&](const Vec3& motion)
        { return pose.scale * distance_to(list, to_model(pose, center + motion)); };
        const double radius = distance(Vec3(0, 0, 0)) * random.between(0.2, 1.0);
        const Vec3 motion = random.in_cube(2.0);
        const double share = sut.share_before(0, motion, radius);
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= 50; ++k)
        {
            least = std::min(least, distance(motion * (share * k / 50.0)));
        }
        ASSERT_GE(least, radius * (1.0 - 1e-9));
        if (share < 1.0)
        {
            ++touched;
            // A few steps come this close to a grazing touch.
            ASSERT_LE(distance(motion * share), radius * (1.0 + 1e-3));
        }
    }
    EXPECT_GT(touched, 200);
    EXPECT_LT(touched, 1'800);
}

TEST(Vicinity, a_sphere_in_a_face_goes_no_way_along_it_or_deeper)
{
    const ObjectPose pose;
    const Material material;
    const auto surface = surface_of(plane(), Vec3(0, 0, 0.1), 10.0);
    const PlacedSurface placed{&pose, surface.get(), &material, 1e-6};
    Vicinity sut({&placed, 1}, Vec3(0, 0, 0.1), 10.0);
    sut.stand_at(Vec3(0, 0, 0), Vec3(0, 0, 1));
    for (const Vec3& motion : {Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(1e-200, 0, 0),
                               Vec3(0, 0, -0.05), Vec3(0.1, 0, -1e-300)})
    {
        EXPECT_EQ(sut.share_before(0, motion, 0.2), 0.0) << motion.transpose();
    }
    EXPECT_EQ(sut.share_before(0, Vec3(0, 0, 0.5), 0.2), 1.0) << "out of it all of the way is free";
    EXPECT_EQ(sut.share_before(0, Vec3(0, 0, 0), 0.05), 1.0);
    EXPECT_NEAR(sut.share_before(0, Vec3(0, 0, -0.1), 0.05), 0.5, 1e-6);
}

} // namespace tactus::test
