// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/limits.hpp"
#include "tests/unit/rt_core/proxy_rig.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

/// Corner of a room: three planes that meet at the origin, free at positive coordinates.
TriangleList room_corner()
{
    TriangleList list;
    add_square(list, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    add_square(list, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
    add_square(list, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
    return list;
}

} // namespace

TEST(Proxy, moves_in_free_flight_only_where_it_is_proven_free)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.5));
    rig.certified = 0.03;

    const ToolOutput output = rig.step(Vec3(0, 0, 0.3));

    EXPECT_FALSE(output.in_contact);
    EXPECT_FALSE(output.halted);
    EXPECT_NEAR(output.proxy_m.z(), 0.5 - (0.03 - kRadius), 1e-5);
}

TEST(Proxy, the_force_over_an_edge_points_from_the_goal_to_the_proxy)
{
    ProxyRig rig(cube(0.05), Vec3(0.07, 0.0, 0.07));

    const ToolOutput output = rig.settle(Vec3(0.052, 0.0, 0.052));

    EXPECT_TRUE(output.in_contact);
    const double rest = 0.05 + kRadius / std::sqrt(2.0);
    expect_vector(output.proxy_m, Vec3(rest, 0, rest), 0.02 * kRadius);
    expect_vector(output.force_n, kStiffness * Vec3(rest - 0.052, 0, rest - 0.052), 0.1);
}

TEST(Proxy, is_clamped_to_the_largest_force)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.02));

    const ToolOutput output = rig.settle(Vec3(0, 0, -1.0));

    EXPECT_NEAR(output.force_n.norm(), 8.0, 1e-9);
    EXPECT_NEAR(output.force_n.z(), 8.0, 1e-6);
}

TEST(Proxy, frozen_in_free_flight_has_no_force)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.5));
    rig.certified = 0.0;

    const ToolOutput output = rig.step(Vec3(0, 0, -0.5));

    EXPECT_TRUE(output.halted);
    EXPECT_EQ(faults_of(output), FrameFault::none) << "there is nothing to fade";
    EXPECT_FALSE(output.in_contact);
    EXPECT_EQ(output.force_n, Vec3(0, 0, 0));
    EXPECT_EQ(output.proxy_m, Vec3(0, 0, 0.5));
}

TEST(Proxy, a_motion_is_worth_a_step_above_the_least_one)
{
    for (const double share : {0.99, 1.01})
    {
        ProxyRig rig(plane(), Vec3(0.1, 0.2, kRadius));
        const double way = share * kLeastStep * kRadius;
        const ToolOutput output = rig.step(Vec3(0.1 + way, 0.2, 0.005));
        EXPECT_EQ(output.proxy_m.x() > 0.1 + 0.5 * way, share > 1.0);
        EXPECT_TRUE(output.in_contact);
    }
}

TEST(Proxy, touches_what_is_as_near_as_its_gap)
{
    const Material rough{kStiffness, 10.0, 10.0, 0.0};
    for (const double share : {0.9, 1.1})
    {
        ProxyRig rig(plane(), Vec3(0, 0, kRadius * (1.0 + share * kTouchShare)));
        rig.material() = rough;
        const ToolOutput output = rig.step(Vec3(0.5 * kRadius, 0, 0.9 * kRadius));
        EXPECT_TRUE(output.in_contact);
        EXPECT_EQ(output.proxy_m.x() > kTouchShare * kRadius, share > 1.0)
            << "what touches sticks where it is, what doesn't goes straight on to where it does";
    }
}

TEST(Proxy, under_friction_slips_when_that_is_worth_it)
{
    const Material rough{kStiffness, 0.5, 0.5, 0.0};
    for (const double share : {0.9, 1.1})
    {
        ProxyRig rig(plane(), Vec3(0, 0, kRadius));
        rig.material() = rough;
        const double depth = 0.1 * kRadius;
        const double way = rough.static_friction * depth + share * kSlipShare * kRadius;
        const ToolOutput output = rig.step(Vec3(way, 0, kRadius - depth));
        EXPECT_TRUE(output.in_contact);
        EXPECT_EQ(output.proxy_m.x() > 0.5 * kSlipShare * kRadius, share > 1.0);
    }
}

TEST(Proxy, at_rest_comes_as_far_in_a_frame_as_is_known)
{
    ProxyRig rig(plane(), Vec3(0, 0, kRadius));
    rig.certified = 1.0;
    const Vec3 goal(0.5, 0, 0.005);
    const ToolOutput output = rig.step(goal);
    EXPECT_FALSE(output.under_way);
    EXPECT_NEAR(output.proxy_m.x(), goal.x(), 1e-6 * kRadius);
    EXPECT_TRUE(output.in_contact);
}

TEST(Proxy, among_more_faces_than_fit_goes_as_far_as_those_that_do_and_on_in_the_next_frame)
{
    // The floor has small squares, as four adjacent objects.
    constexpr int kSquares = 22;
    constexpr double kEdge = 0.1 * kRadius;
    std::vector<Solid> floor(4);
    for (int i = -kSquares; i < kSquares; ++i)
    {
        for (int j = -kSquares; j < kSquares; ++j)
        {
            const auto at = [&](int di, int dj)
            { return Vec3((i + di) * kEdge, (j + dj) * kEdge, 0.0); };
            add_square(floor[(i < 0 ? 0U : 1U) + (j < 0 ? 0U : 2U)].triangles, at(0, 0), at(1, 0),
                       at(1, 1), at(0, 1));
        }
    }
    ProxyRig rig(floor, Vec3(0, 0, kRadius));
    rig.certified = 2.2 * kRadius;
    const Vec3 goal(kRadius, 0, 0.5 * kRadius);
    bool was_under_way = false;
    ToolOutput output;
    for (int frame = 0; frame < 10; ++frame)
    {
        output = rig.step(goal);
        was_under_way = was_under_way || output.under_way;
        ASSERT_FALSE(output.halted);
        ASSERT_GE(output.proxy_m.z(), kRadius * (1.0 - 2e-6));
    }
    EXPECT_TRUE(was_under_way);
    EXPECT_TRUE(output.in_contact);
    EXPECT_NEAR(output.proxy_m.x(), goal.x(), 1e-3 * kRadius);
}

/// Step of a proxy at the origin that came from far away.
ToolOutput leap_among(const TriangleList& triangles, const Vec3& goal, Proxy& sut)
{
    const ObjectPose pose;
    const Material material;
    const auto surface = surface_of(triangles, Vec3(0, 0, 0), 100.0);
    ProxyMemory memory;
    const PlacedSurface placed = placed_surface(pose, surface.get(), material, memory);
    sut.see(goal_at(Vec3(0, 0, 1'000)));
    static_cast<void>(sut.respond(goal_at(Vec3(0, 0, 0)), {}, kInfinity));
    return sut.respond(goal_at(goal), {&placed, 1}, kInfinity);
}

/// Bent top of a prism with `faces` sides on a quarter of a circle of 2 m; a sphere lies on its
/// first edge.
TriangleList bent_top(int faces)
{
    const auto at = [faces](int i, double y)
    {
        const double angle = 0.5 * std::numbers::pi * i / faces;
        return Vec3(2.0 * std::sin(angle), y, 2.0 * std::cos(angle) - 2.0 - kRadius);
    };
    TriangleList list;
    for (int i = 0; i < faces; ++i)
    {
        add_square(list, at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1));
    }
    return list;
}

TEST(Proxy, goes_on_in_the_next_frame_when_its_steps_are_over)
{
    const Vec3 goal(6, 0, -6);
    Proxy few(sphere_tool());
    EXPECT_FALSE(leap_among(bent_top(5), goal, few).under_way);
    EXPECT_LT(few.path_m().size(), kProxySteps);

    Proxy many(sphere_tool());
    EXPECT_TRUE(leap_among(bent_top(60), goal, many).under_way);
    EXPECT_EQ(many.path_m().size(), kProxySteps)
        << "where it was, and after all steps but the last";
    EXPECT_GT(many.position_m().x(), 0.1);
    EXPECT_GT(distance_to(bent_top(60), many.position_m()), kRadius * (1.0 - 2e-6));
}

TEST(Proxy, among_more_faces_than_a_step_has_rounds_enters_none_and_comes_to_rest)
{
    Random random(77);
    for (int scene = 0; scene < 200; ++scene)
    {
        TriangleList points; // Bowl below and around the sphere, of any width.
        const double width = random.between(0.05, 1.0);
        while (points.size() < std::size_t{8} * kStepRounds)
        {
            const Vec3 way = random.in_cube(1.0).normalized();
            const Vec3f at = to_float(Vec3(width * way.x(), way.y(), -std::abs(way.z())));
            points.push_back({at, at, at});
        }
        const Vec3 goal = random.in_cube(1.0) + Vec3(0, 0, -2);
        Proxy sut(sphere_tool());
        static_cast<void>(leap_among(points, goal, sut));
        const std::span<const Vec3> path = sut.path_m();
        for (std::size_t i = 1; i < path.size(); ++i)
        {
            for (int share = 0; share <= 8; ++share)
            {
                const Vec3 at = path[i - 1] + (path[i] - path[i - 1]) * (share / 8.0);
                ASSERT_GE(distance_to(points, at), kRadius * (1.0 - 2e-6)) << scene;
            }
        }
        ASSERT_LT((sut.position_m() - goal).norm(), goal.norm()) << scene;
    }
}

TEST(Proxy, of_few_planes_a_frame_gets_to_the_same_place_later_and_says_so)
{
    const Vec3 start(0, 0, 0);
    const Vec3 goal(0.3, 0, -0.05);
    ProxyRig whole(bent_top(60), start);
    whole.certified = 1.0;
    const ToolOutput rest = whole.settle(goal, 20);
    ASSERT_FALSE(rest.under_way);
    for (const std::uint32_t planes : {1U, 12U, 40U})
    {
        ProxyRig rig(bent_top(60), start);
        rig.certified = 1.0;
        rig.planes = planes;
        ToolOutput output;
        double force_n = 0.0;
        int cut = 0;
        for (int frame = 0; frame < 2'000; ++frame)
        {
            const Vec3 before_n = output.force_n;
            output = rig.step(goal);
            ASSERT_LE(rig.sut.planes_left(), planes);
            ASSERT_EQ(output.cut_short,
                      has_fault(frame_faults(output), FrameFault::plane_budget_spent));
            ASSERT_TRUE(output.under_way || !output.cut_short);
            ASSERT_GE(rig.clearance(), kRadius * (1.0 - 2e-6));
            const double step_n = (output.force_n - before_n).norm();
            force_n = cut > 0 ? std::max(force_n, step_n) : force_n;
            cut += output.cut_short ? 1 : 0;
            if (!output.under_way)
            {
                break;
            }
        }
        EXPECT_GT(cut, 0) << planes;
        EXPECT_LE(force_n, kCatchUp_n_per_s * kPeriod_s * (1.0 + 1e-9)) << planes;
        EXPECT_FALSE(output.under_way) << planes;
        EXPECT_LT((output.proxy_m - rest.proxy_m).norm(), 1e-4 * kRadius) << planes;
    }
}

/// Waves along x, three tenths of the radius high, in squares of a fifth of it.
TriangleList waves()
{
    constexpr int kHalf = 12;
    const auto at = [](int i, int j)
    {
        const double height = std::sin(0.3 * i) * std::cos(0.3 * j) - 1.0;
        return Vec3(0.2 * kRadius * i, 0.2 * kRadius * j, 0.3 * kRadius * height);
    };
    TriangleList list;
    for (int i = -kHalf; i < 70; ++i)
    {
        for (int j = -kHalf; j < kHalf; ++j)
        {
            add_square(list, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return list;
}

/// The goal is far beyond the list's permitted motion. A query for the whole path would cost a
/// lagging proxy ever more time.
TEST(Proxy, behind_a_fast_hand_asks_no_farther_than_it_may_go)
{
    ProxyRig rig(waves(), Vec3(0, 0, kRadius));
    rig.material().static_friction = 0.3;
    rig.material().dynamic_friction = 0.24;
    rig.certified = 1.5 * kRadius;
    rig.settle(Vec3(0, 0, 0.5 * kRadius), 3);
    rig.planes = 700;
    Vec3 goal(0, 0, 0.4 * kRadius);
    for (int frame = 0; frame < 8; ++frame)
    {
        goal.x() += 1.5 * kRadius;
        const ToolOutput output = rig.step_on(goal, Vec3(1.5 * kRadius / kPeriod_s, 0, 0));
        EXPECT_FALSE(output.cut_short) << frame;
        EXPECT_GT(output.force_n.norm(), 0.0) << frame;
        EXPECT_LT(output.lag_m, 0.5 * kRadius) << frame;
    }
}

TEST(Proxy, without_any_plane_stays_and_feels_what_touches)
{
    ProxyRig rig(plane(), Vec3(0, 0, kRadius));
    rig.planes = 0;
    const ToolOutput output = rig.step(Vec3(0.1, 0, kRadius - 0.002));
    EXPECT_TRUE(output.cut_short);
    EXPECT_EQ(output.proxy_m, Vec3(0, 0, kRadius));
    EXPECT_NEAR(output.force_n.z(), kStiffness * 0.002, 1e-6);
    EXPECT_GT(output.lag_m, 0.09);
}

TEST(Proxy, says_that_it_is_crowded_when_more_touches_than_planes_fit)
{
    for (const std::size_t count : {std::size_t{kMaxHalfSpaces}, std::size_t{kMaxHalfSpaces} + 1})
    {
        ProxyRig rig(TriangleList(count, plane().front()), Vec3(0.5, 0, kRadius));
        const ToolOutput output = rig.step(Vec3(0.5, 0, 0.005));
        EXPECT_TRUE(output.in_contact);
        EXPECT_EQ(rig.sut.exceeds_capacity(), count > kMaxHalfSpaces);
        rig.step(Vec3(0.5, 0, 0.5));
        EXPECT_FALSE(rig.settle(Vec3(0.5, 0, 0.5), 3).in_contact);
        EXPECT_FALSE(rig.sut.exceeds_capacity());
    }
}

TEST(Proxy, data_limited_before_an_edge_and_let_go_the_force_turns_by_its_rate_or_the_devices_share)
{
    for (const double force_max_n : {8.0, 2.0})
    {
        ToolSpec tool = sphere_tool();
        tool.force_max_n = force_max_n;
        const double rate_n_per_s = std::min(kCatchUp_n_per_s, kCatchUpShare_per_s * force_max_n);
        EXPECT_EQ(rate_n_per_s < kCatchUp_n_per_s, force_max_n < 8.0);
        const Vec3 goal(0.052, 0.0, 0.045); // Nearer to the side.
        ProxyRig free(cube(0.05), Vec3(0.045, 0.0, 0.07), {}, tool);
        free.settle(Vec3(0.045, 0.0, 0.058));
        const Vec3 turned = free.settle(goal).force_n;
        ProxyRig rig(cube(0.05), Vec3(0.045, 0.0, 0.07), {}, tool);
        rig.settle(Vec3(0.045, 0.0, 0.058));
        rig.certified = kRadius + 0.001;
        Vec3 before = rig.step(goal).force_n;
        ASSERT_TRUE(rig.step(goal).data_limited);
        ASSERT_GT((turned - before).norm(), 0.25 * force_max_n);
        before = rig.step(goal).force_n;
        rig.certified = 0.05;
        const double step_n = rate_n_per_s * kPeriod_s;
        int steps = 0;
        for (int frame = 0; frame < 400; ++frame)
        {
            const Vec3 force = rig.step(goal).force_n;
            ASSERT_LE((force - before).norm(), step_n + 1e-9) << frame;
            steps += (force - before).norm() > 0.9 * step_n ? 1 : 0;
            before = force;
        }
        EXPECT_GT(steps, 20) << "it did not turn";
        expect_vector(before, turned, 0.05);
    }
}

TEST(Proxy, the_same_scene_under_any_pose_and_scale_gives_the_same_force)
{
    ObjectPose pose;
    pose.rotation = (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
    pose.translation_m = Vec3(3, -2, 1);
    pose.scale = 4.0;
    TriangleList shrunk = cube(0.05 / pose.scale);
    ObjectPose upright;
    ProxyRig rig(cube(0.05), Vec3(0.02, 0.01, 0.08), upright);
    const auto to_turned = [&pose](const Vec3& v)
    { return Vec3(pose.translation_m + pose.rotation * v); };
    ProxyRig turned(shrunk, to_turned(Vec3(0.02, 0.01, 0.08)), pose);
    turned.certified = rig.certified / pose.scale;
    Random random(74);
    Vec3 goal(0.02, 0.01, 0.08);
    for (int i = 0; i < 200; ++i)
    {
        goal += Vec3(0.0001, 0.0, -0.0004);
        const ToolOutput expected = rig.step(goal);
        const ToolOutput output = turned.step(to_turned(goal));
        ASSERT_EQ(output.in_contact, expected.in_contact) << i;
        ASSERT_NEAR((output.force_n - pose.rotation * expected.force_n).norm(), 0.0, 1e-3) << i;
        ASSERT_NEAR((output.proxy_m - to_turned(expected.proxy_m)).norm(), 0.0, 2e-6) << i;
    }
    EXPECT_GT(rig.step(goal).force_n.norm(), 1.0);
}

TEST(Proxy, two_objects_hold_it_together)
{
    TriangleList wall;
    add_square(wall, {0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1});
    ProxyRig rig({{plane()}, {wall}}, Vec3(0.05, 0, 0.05));
    for (int i = 0; i < 300; ++i)
    {
        rig.step(Vec3(0.004, 0, 0.006));
        ASSERT_GE(rig.sut.position_m().x(), kRadius * (1.0 - 2e-6));
        ASSERT_GE(rig.sut.position_m().z(), kRadius * (1.0 - 2e-6));
    }
    EXPECT_LT((rig.sut.position_m() - Vec3(kRadius, 0, kRadius)).norm(), 0.1 * kRadius);
}

TEST(Proxy, rests_in_a_concave_corner_within_one_frame)
{
    ProxyRig rig(room_corner(), Vec3(0.03, 0.025, 0.02));
    const Vec3 goal(0.002, 0.003, 0.001);

    const ToolOutput output = rig.step(goal);

    const Vec3 corner(kRadius, kRadius, kRadius);
    EXPECT_TRUE(output.in_contact);
    expect_vector(output.proxy_m, corner, 3e-4 * kRadius);
    expect_vector(output.force_n, kStiffness * (corner - goal), kStiffness * 3e-4 * kRadius);
}

TEST(Proxy, leaves_a_corner_along_the_edge_that_still_holds_it)
{
    ProxyRig rig(room_corner(), Vec3(0.05, 0.04, 0.06));
    rig.settle(Vec3(0.002, 0.003, 0.001));

    const ToolOutput output = rig.settle(Vec3(0.002, 0.003, 0.06), 100);

    expect_vector(output.proxy_m, Vec3(kRadius, kRadius, 0.06), 1e-3 * kRadius);
    EXPECT_NEAR(output.force_n.z(), 0.0, 1e-3);
    EXPECT_NEAR(output.force_n.x(), kStiffness * 0.008, 1e-2);
    EXPECT_NEAR(output.force_n.y(), kStiffness * 0.007, 1e-2);
}

/// Steps to a goal. Expects the whole path to be free.
void step_freely(ProxyRig& rig, const Vec3& goal)
{
    const Vec3 before = rig.sut.position_m();
    EXPECT_LE(rig.step(goal).force_n.norm(), 8.0 + 1e-9);
    const std::span<const Vec3> path = rig.sut.path_m();
    ASSERT_EQ(path.front(), before);
    ASSERT_EQ(path.back(), rig.sut.position_m());
    for (std::size_t k = 1; k < path.size(); ++k)
    {
        for (int share = 0; share <= 16; ++share)
        {
            const Vec3 at = path[k - 1] + (path[k] - path[k - 1]) * (share / 16.0);
            ASSERT_GE(rig.clearance_at(at), kRadius * (1.0 - 2e-6));
        }
    }
}

/// The hand jumps, and wanders across the cube and into the corner of a room.
TEST(Proxy, every_step_of_its_path_is_free)
{
    Random random(75);
    ProxyRig sut(cube(0.05), Vec3(0.0, 0.0, 0.08));
    ProxyRig in_corner(room_corner(), Vec3(0.05, 0.05, 0.05));
    Vec3 goal(0, 0, 0.08);
    for (int i = 0; i < 8'000 && !testing::Test::HasFatalFailure(); ++i)
    {
        SCOPED_TRACE("frame " + std::to_string(i));
        goal =
            i < 2'000 || i % 500 == 0 ? random.in_cube(0.09) : Vec3(goal + random.in_cube(0.004));
        goal = goal.cwiseMax(-0.1).cwiseMin(0.1);
        step_freely(sut, goal);
        step_freely(in_corner, Vec3(0.02, 0.02, 0.02) + random.in_cube(i % 4 == 0 ? 0.5 : 0.06));
        ASSERT_GT(sut.sut.position_m().cwiseAbs().maxCoeff(), 0.05) << "inside";
        ASSERT_GE(in_corner.sut.position_m().minCoeff(), kRadius * (1.0 - 2e-6));
    }
}

TEST(Proxy, a_tool_without_a_radius_stays_a_skin_away)
{
    Random random(76);
    ToolSpec point = sphere_tool();
    point.radius_m = 0.0;
    ProxyRig rig(cube(0.05), Vec3(0.0, 0.0, 0.08), {}, point);
    rig.quantum = 1e-6;
    for (int i = 0; i < 2'000; ++i)
    {
        rig.step(random.in_cube(0.08));
        ASSERT_GE(rig.clearance(), kPointSkin * rig.quantum * (1.0 - 1e-4)) << i;
        ASSERT_GT(rig.sut.position_m().cwiseAbs().maxCoeff(), 0.05) << i;
    }
    const ToolOutput output = rig.settle(Vec3(0.0, 0.0, 0.049));
    ASSERT_TRUE(output.in_contact);
}

TEST(Proxy, a_point_with_no_surface_near_goes_as_far_as_everything_is_clear)
{
    ToolSpec point = sphere_tool();
    point.radius_m = 0.0;
    for (const double hand_m : {0.0, 1.0, 2.9999999, 3.1, 6.0, 7.3})
    {
        ProxyRig rig(std::vector<Solid>{}, Vec3(0.0, 0.0, 0.0), point);
        rig.clear = 3.0;
        const Vec3 hand = hand_m * Vec3(0.1, 0.7, -0.3).normalized();
        const ToolOutput output = rig.step(hand);
        EXPECT_NEAR(rig.sut.position_m().norm(), std::min(hand_m, 3.0), 1e-9) << hand_m;
        EXPECT_FALSE(output.in_contact);
        EXPECT_EQ(output.force_n, Vec3(0.0, 0.0, 0.0));
    }
}

/// Both sides of a gap narrower than the sphere, or of a thinner plate.
TEST(Proxy, without_room_rests_and_moves_exactly_along_the_walls_with_friction_and_without)
{
    constexpr std::array<double, 4> kRoom_m{-1e-4, 0.0, 1e-4, 1.1 * kRadius};
    for (const double room_m : kRoom_m)
    {
        for (const double friction : {0.0, 0.3})
        {
            TriangleList walls = plane();
            for (const auto& face : plane())
            {
                walls.push_back(face);
                for (Vec3f& corner : walls.back())
                {
                    corner[2] = static_cast<float>(room_m);
                }
            }
            ProxyRig rig(walls, Vec3(0.1, 0.0, 0.5 * room_m));
            rig.material() = {kStiffness, friction, friction, 0.0};
            Vec3 hand(0.1, 0.0, 0.5 * room_m);
            for (const double step_m : {0.0, 1e-6, 1e-12, 1e-3, -1e-200})
            {
                for (int frame = 0; frame < 20; ++frame)
                {
                    hand.x() += step_m;
                    const ToolOutput output = rig.step(hand);
                    ASSERT_EQ(output.over_constrained, room_m != 0.0)
                        << room_m << ", " << friction << ", " << step_m;
                    ASSERT_TRUE(output.force_n.allFinite());
                    ASSERT_TRUE(rig.sut.position_m().allFinite());
                }
            }
        }
    }
}

/// A server may report an object with almost no stiffness.
TEST(Proxy, a_push_too_weak_for_a_direction_leaves_the_last_one)
{
    ProxyRig rig(plane(), Vec3(0.1, 0.0, 0.02));
    rig.settle(Vec3(0.1, 0.0, 0.005), 20);
    rig.material().stiffness_n_per_m = 1e-200;
    rig.settle(Vec3(0.1, 0.0, 0.004), 20);
    const Vec3 across(0.1, 0.0, 0.5);
    for (int frame = 0; frame < 20; ++frame)
    {
        const ToolOutput output = rig.step(across);
        ASSERT_TRUE(output.force_n.allFinite());
    }
    EXPECT_NEAR((rig.sut.position_m() - across).norm(), 0.0, 1e-6);
}

TEST(Proxy, friction_rounds_a_sphere_as_well)
{
    // Fan of thin faces: the bent top of a cylinder of radius 0.1 along y.
    TriangleList list;
    const auto on_top = [](int i, double y)
    { return Vec3(0.1 * std::sin(0.01 * i), y, 0.1 * std::cos(0.01 * i)); };
    for (int i = -60; i < 60; ++i)
    {
        add_square(list, on_top(i, -0.1), on_top(i + 1, -0.1), on_top(i + 1, 0.1), on_top(i, 0.1));
    }
    ProxyRig rig(list, Vec3(0, 0, 0.115));
    rig.certified = 0.03;
    rig.material() = {kStiffness, 0.4, 0.4, 0.0};
    rig.settle(Vec3(0, 0, 0.107), 5);
    double sum = 0.0;
    for (int i = 0; i <= 300; ++i)
    {
        const double angle = 0.001 * i;
        const ToolOutput output = rig.step(0.107 * Vec3(std::sin(angle), 0.0, std::cos(angle)));
        const Vec3 normal = (output.proxy_m - rig.nearest(output.proxy_m)).normalized();
        const double across = output.force_n.dot(normal);
        const double along = (output.force_n - across * normal).norm();
        ASSERT_LE(along, 0.4 * across * (1.0 + 1e-9)) << i;
        sum += i > 100 ? along / across : 0.0;
    }
    EXPECT_GT(sum / 200.0, 0.36); // The sphere rolls slightly farther over an edge than on a face.
}

TEST(Proxy, on_a_viscous_surface_makes_no_energy_however_the_hand_goes)
{
    for (std::uint32_t seed = 1; seed <= 8; ++seed)
    {
        Random random(seed);
        ProxyRig rig(plane(), Vec3(0, 0, 0.02));
        rig.material().viscosity_n_s_per_m = std::pow(10.0, random.between(-2.0, 4.0));
        Vec3 hand = Vec3(0, 0, kRadius - 0.002);
        (void)rig.settle(hand, 20);
        double work_j = 0.0;
        for (int step = 0; step < 4'000; ++step)
        {
            Vec3 next = hand + random.in_cube(5e-4);
            next.z() = hand.z(); // Along the surface only: there is no other spring to test.
            next *= std::min(1.0, 0.05 / next.norm());
            next.z() = hand.z();
            const ToolOutput now = rig.step(next);
            work_j += now.force_n.dot(next - hand);
            const double stretch_m = (now.proxy_m - next).head<2>().norm();
            // Never more than the spring's energy, which was supplied to it.
            EXPECT_LE(work_j + 0.5 * kStiffness * stretch_m * stretch_m, 1e-5) << seed;
            hand = next;
        }
    }
}

TEST(Proxy, a_pull_across_a_frozen_surface_does_not_turn_the_force)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.02));
    rig.settle(Vec3(0, 0, 0.002));
    rig.certified = 0.0;

    const ToolOutput output = rig.step(Vec3(0.05, 0.02, 0.002));

    ASSERT_GT(output.force_n.norm(), 0.1);
    EXPECT_NEAR(cosine(output.force_n, Vec3(0, 0, 1)), 1.0, 1e-9);
}

TEST(Proxy, crosses_many_small_triangles_in_one_frame)
{
    // Strip of thin faces: the bent top of a cylinder of radius 0.1 along y.
    TriangleList list;
    const auto on_top = [](int i, double y)
    { return Vec3(0.1 * std::sin(0.002 * i), y, 0.1 * std::cos(0.002 * i)); };
    for (int i = -50; i < 50; ++i)
    {
        add_square(list, on_top(i, -0.1), on_top(i + 1, -0.1), on_top(i + 1, 0.1), on_top(i, 0.1));
    }
    for (const double way : {0.0005, 0.002, 0.005})
    {
        ProxyRig rig(list, Vec3(-0.005, 0, 0.115));
        rig.certified = 0.03;
        rig.settle(Vec3(-0.005, 0, 0.108), 3);
        for (double x = -0.005; x < 0.006; x += way)
        {
            const Vec3 goal = 0.108 * Vec3(x, 0, 0.1).normalized();
            const ToolOutput output = rig.step(goal);
            ASSERT_GE(rig.clearance(), kRadius * (1.0 - 2e-6));
            ASSERT_TRUE(output.in_contact) << way << " m at " << x;
            // Facets 0.2 mm wide: the arc's sagitta and half an edge's angle.
            expect_vector(output.force_n, kStiffness * 0.002 * goal.normalized(), 0.02);
        }
    }
}

TEST(Proxy, of_a_fast_hand_goes_on_with_further_lists_of_the_same_frame)
{
    ProxyRig rig(plane(), Vec3(0, 0, kRadius));
    rig.settle(Vec3(0, 0, 0.5 * kRadius));
    rig.certified = 1.4 * kRadius;
    const Vec3 start = rig.sut.position_m();
    const Vec3 near(kRadius, 0, 0.5 * kRadius);
    const ToolOutput there = rig.step_on(near, near / kPeriod_s);
    EXPECT_EQ(rig.lists, 3U);
    EXPECT_NEAR(there.proxy_m.x(), kRadius, 1e-6 * kRadius);
    EXPECT_FALSE(there.under_way);
    EXPECT_EQ(there.lag_m, 0.0);
    // The path of one frame begins at its start.
    EXPECT_EQ(rig.sut.path_m().front(), start);
    EXPECT_EQ(rig.sut.path_m().back(), rig.sut.position_m());

    const Vec3 far = near + Vec3(10 * kRadius, 0, 0);
    const ToolOutput behind = rig.step_on(far, (far - near) / kPeriod_s);
    EXPECT_EQ(rig.lists, Proxy::kListsPerFrame);
    EXPECT_NEAR(behind.proxy_m.x(), kRadius * (1.0 + 0.4 * Proxy::kListsPerFrame), 0.01 * kRadius);
    EXPECT_TRUE(behind.under_way);
    EXPECT_NEAR(behind.lag_m, rig.sut.way_to_m(goal_at(far)), 1e-12);
    EXPECT_NEAR(behind.lag_m, far.x() - behind.proxy_m.x(), 0.1 * kRadius);
}

TEST(Proxy, does_not_go_on_where_data_is_missing_or_a_list_brings_it_no_farther)
{
    ProxyRig rig(plane(), Vec3(0, 0, kRadius));
    rig.settle(Vec3(0, 0, 0.5 * kRadius));
    rig.certified = 1.4 * kRadius;
    const Vec3 goal(kRadius, 0, 0.5 * kRadius);
    EXPECT_TRUE(rig.step(goal).under_way);
    EXPECT_FALSE(rig.sut.goes_on());
    rig.certified = 1.01 * kRadius;
    EXPECT_TRUE(rig.step_on(goal, Vec3(0, 0, 0)).under_way);
    EXPECT_EQ(rig.lists, 1U);
}

TEST(Proxy, frozen_when_it_goes_on_stays_as_it_was)
{
    ProxyRig rig(plane(), Vec3(0, 0, kRadius));
    ProxyRig other(plane(), Vec3(0, 0, kRadius));
    const Vec3 goal(kRadius, 0, 0.5 * kRadius);
    for (ProxyRig* each : {&rig, &other})
    {
        each->settle(Vec3(0, 0, 0.5 * kRadius));
        each->certified = 1.4 * kRadius;
        static_cast<void>(each->step(goal));
    }
    rig.certified = 0.0;
    rig.sut.go_on();
    EXPECT_TRUE(rig.step(goal).halted);
    rig.certified = 1.4 * kRadius;
    EXPECT_EQ(rig.step(goal).force_n, other.step(goal).force_n);
    EXPECT_EQ(rig.sut.position_m(), other.sut.position_m());
}

TEST(Proxy, behind_a_fast_hand_is_never_without_force_and_on_it_again_when_that_slows)
{
    ProxyRig rig(plane(), Vec3(0, 0, kRadius));
    rig.settle(Vec3(0, 0, 0.5 * kRadius));
    rig.certified = 1.06 * kRadius; // 0.6 mm a list.
    Vec3 goal(0, 0, 0.5 * kRadius);
    double lag_m = 0.0;
    for (int frame = 0; frame < 100; ++frame)
    {
        goal.x() += 0.003;
        const ToolOutput output = rig.step_on(goal, Vec3(3, 0, 0));
        ASSERT_GT(output.force_n.norm(), 0.0) << frame;
        ASSERT_FALSE(output.halted);
        ASSERT_GE(output.lag_m, lag_m);
        lag_m = output.lag_m;
    }
    EXPECT_NEAR(lag_m, 0.06, 0.01);
    int frames = 0;
    for (; lag_m > 0.0 && frames < 50; ++frames)
    {
        goal.x() += 0.001;
        lag_m = rig.step_on(goal, Vec3(1, 0, 0)).lag_m;
    }
    EXPECT_EQ(lag_m, 0.0) << frames;
    EXPECT_NEAR(rig.sut.position_m().x(), goal.x(), 1e-6 * kRadius);
}

TEST(Proxy, a_press_is_little_of_a_way_but_a_pull_is)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.02));
    EXPECT_NEAR(rig.sut.way_to_m(goal_at(Vec3(0, 0.03, -0.02))), 0.05, 1e-15);
    rig.settle(Vec3(0, 0, 0.005));
    EXPECT_NEAR(rig.sut.way_to_m(goal_at(Vec3(0, 0.003, 0.0))), 0.004, 1e-9);
    EXPECT_NEAR(rig.sut.way_to_m(goal_at(Vec3(0, 0.03, kRadius + 0.04))), 0.05, 1e-9);
}

} // namespace tactus::test
