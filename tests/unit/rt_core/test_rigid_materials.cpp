// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// What an object's material does to a tool that is held as a body: stiffness, damping, friction.
/// The oracles are the laws of statics: a spring's, a damper's, and Coulomb's.

#include "rt_core/force/angular_stiffness.hpp"
#include "tests/unit/rt_core/body_rig.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tactus::test
{

namespace
{

/// A box at rest on a plane, just touching it.
Rig box_on_plane(const Material& material)
{
    Rig rig = on_plane(Box{kHalf}, material);
    rig.settle(Vec3(0, 0, 0.05));
    rig.settle(Vec3(0, 0, kHalf.z() + kBodyRadius - 1e-5));
    return rig;
}

/// How far the box comes along the plane when the hand pulls as weight does on such a slope, and
/// the force at the end.
struct Pull
{
    double way_m;
    ToolOutput last;
};

Pull pull(const Material& material, double slope_rad, double heading_rad, int frames = 400)
{
    Rig rig = box_on_plane(material);
    const Vec3 start = rig.sut.place().translation_m;
    constexpr double kDepth = 0.004;
    const Vec3 along(std::cos(heading_rad), std::sin(heading_rad), 0.0);
    // The hand is pressed in first, then drawn along, no farther ahead than weight would have it.
    rig.settle(start - Vec3(0, 0, kDepth), Mat3::Identity(), 50);
    const double ahead_m = kDepth * std::tan(slope_rad);
    ToolOutput last;
    for (int i = 0; i < frames; ++i)
    {
        Vec3 from = rig.sut.place().translation_m;
        from.z() = start.z() - kDepth;
        const double share = std::min(1.0, i / 100.0);
        last = rig.step(from + share * ahead_m * along);
    }
    return {(rig.sut.place().translation_m - start).norm(), last};
}

double kinetic_ratio(const ToolOutput& output)
{
    return Vec3(output.force_n.x(), output.force_n.y(), 0.0).norm() / output.force_n.z();
}

} // namespace

TEST(RigidMaterials, the_softer_of_tool_and_object_is_the_spring)
{
    for (const double stiffness : {50.0, 200.0, 800.0})
    {
        Material material;
        material.stiffness_n_per_m = stiffness;
        Rig rig = box_on_plane(material);

        const ToolOutput output = rig.settle(Vec3(0, 0, -0.004), turn(Vec3(1, 0, 0), 0.05));

        const double softer = std::min(stiffness, kBodyStiffness);
        EXPECT_NEAR(output.stiffness_n_per_m, softer, 1e-9 * softer);
        EXPECT_LE((output.force_n - softer * (output.proxy_m - Vec3(0, 0, -0.004))).norm(),
                  1e-3 * output.force_n.norm());
        const Eigen::AngleAxisd held(output.proxy_rotation * turn(Vec3(1, 0, 0), -0.05));
        const double arm = kHalf.norm() + kBodyRadius;
        EXPECT_NEAR(output.torque_nm.norm(), softer * arm * arm * held.angle(),
                    0.02 * output.torque_nm.norm());
    }
}

TEST(RigidMaterials, of_two_objects_each_pushes_by_its_own_stiffness)
{
    Material soft;
    soft.stiffness_n_per_m = 100.0;
    // A corner of two walls; the hand is as deep behind each of them.
    Rig rig(tool_of(Segment{{0, 0, -0.01}, {0, 0, 0.01}}), {{plane(), {}}, {plane(), {}, soft}});
    rig.objects[1].pose.rotation = turn(Vec3(0, 1, 0), std::numbers::pi / 2.0);
    rig.settle(Vec3(0.03, 0, 0.05));

    const ToolOutput output = rig.settle(Vec3(-0.003, 0, 0.007));

    const Vec3 between = output.proxy_m - Vec3(-0.003, 0, 0.007);
    EXPECT_NEAR(output.force_n.x(), 100.0 * between.x(), 1e-3);
    EXPECT_NEAR(output.force_n.z(), kBodyStiffness * between.z(), 1e-2);
}

TEST(RigidMaterials, the_angular_stiffness_is_what_is_set)
{
    for (const double set : {0.02, 0.3, 5.0})
    {
        ToolSpec spec = tool_of(Box{kHalf});
        spec.angular_stiffness_nm_per_rad = set;
        EXPECT_NEAR(angular_stiffness_nm_per_rad(spec), set, 1e-12 * set);
        Rig rig(spec, {{plane(), {}}});
        rig.settle(Vec3(0, 0, 0.05));
        const Mat3 tilted = turn(Vec3(0, 1, 0), 0.03);

        const ToolOutput output = rig.settle(Vec3(0, 0, -0.02), tilted, 900);

        const Eigen::AngleAxisd held(output.proxy_rotation * tilted.transpose());
        EXPECT_GT(held.angle(), 1e-3);
        EXPECT_LE((output.torque_nm - set * held.angle() * held.axis()).norm(),
                  0.02 * output.torque_nm.norm())
            << set;
        EXPECT_NEAR(rig.distance(), kBodyRadius, 2e-3 * kBodyRadius);
    }
    ToolSpec unset = tool_of(Box{kHalf});
    const double arm = kHalf.norm() + kBodyRadius;
    EXPECT_NEAR(angular_stiffness_nm_per_rad(unset), kBodyStiffness * arm * arm, 1e-12);
    EXPECT_NEAR(angular_lever_m(unset), arm, 1e-12);
    unset.core = PointCore{};
    EXPECT_EQ(angular_stiffness_nm_per_rad(unset), 0.0);
    EXPECT_EQ(angular_lever_m(unset), 0.0);
}

TEST(RigidMaterials, damping_is_of_the_motion_across_the_surface_and_never_pulls)
{
    Material material;
    material.damping_n_s_per_m = 8.0;
    Rig rig = box_on_plane(material);
    rig.settle(Vec3(0, 0, 0.008));
    ToolGoal hand = hand_at(Vec3(0, 0, 0.008));
    const double still_n = rig.step(hand).force_n.z();

    hand.velocity_m_per_s = Vec3(0, 0, -0.05);
    EXPECT_NEAR(rig.step(hand).force_n.z(), still_n + 8.0 * 0.05, 1e-6);
    hand.velocity_m_per_s = Vec3(0.2, 0.1, 0.05);
    EXPECT_NEAR(rig.step(hand).force_n.z(), still_n - 8.0 * 0.05, 1e-6);
    hand.velocity_m_per_s = Vec3(0, 0, 10.0);
    EXPECT_GE(rig.step(hand).force_n.z(), 0.0) << "a hand that tears itself away";
    hand.velocity_m_per_s = Vec3(0, 0, 0);
    // Turning, one side comes in as fast as the other one goes out; what rests on both is braked.
    hand.spin_rad_per_s = Vec3(0, 1.0, 0);
    EXPECT_LT(rig.step(hand).torque_nm.y(), -1e-4);
    hand.spin_rad_per_s = Vec3(0, 0, 0);
    // An object that comes nearer.
    rig.objects[0].pose.translation_m.z() += 1e-5;
    EXPECT_NEAR(rig.step(hand).force_n.z(), still_n + 8.0 * 0.01 + kBodyStiffness * 1e-5, 0.02);
}

TEST(RigidMaterials, a_block_on_a_slope_sticks_and_slides_at_the_angle_of_friction)
{
    for (const double friction : {0.1, 0.3, 0.6, 1.0})
    {
        Material material;
        material.static_friction = friction;
        material.dynamic_friction = friction;
        for (const double heading : {0.0, 0.4, 0.785, 2.0, 4.0})
        {
            const double angle = std::atan(friction);
            const Pull below = pull(material, 0.99 * angle, heading);
            const Pull above = pull(material, 1.01 * angle, heading);
            EXPECT_LT(below.way_m, 1e-5) << friction << ' ' << heading;
            EXPECT_NEAR(kinetic_ratio(below.last), std::tan(0.99 * angle), 1e-3 * friction);
            EXPECT_GT(above.way_m, 1e-4) << friction << ' ' << heading;
            EXPECT_NEAR(kinetic_ratio(above.last), friction, 0.01 * friction);
        }
    }
}

TEST(RigidMaterials, sliding_fast_meets_coulombs_force_against_the_motion)
{
    Material material;
    material.static_friction = 0.5;
    material.dynamic_friction = 0.3;
    for (const double step_m : {1e-5, 1e-4, 5e-4})
    {
        Rig rig = box_on_plane(material);
        Vec3 goal(0, 0, 0.008);
        rig.settle(goal);
        ToolOutput output;
        for (int i = 0; i < 1'500 && goal.x() < 0.3; ++i)
        {
            goal.x() += step_m;
            output = rig.step(goal);
        }
        EXPECT_TRUE(rig.sut.slides());
        EXPECT_NEAR(-output.force_n.x(), 0.3 * output.force_n.z(), 0.003 * output.force_n.z());
        EXPECT_NEAR(output.force_n.y(), 0.0, 1e-3);
        EXPECT_NEAR(output.force_n.z(), kBodyStiffness * 0.004, 0.01);
    }
}

TEST(RigidMaterials, what_sticks_does_not_move_by_a_bit_for_a_minute)
{
    Material material;
    material.static_friction = 0.5;
    material.dynamic_friction = 0.4;
    Rig rig = box_on_plane(material);
    const Vec3 hand(0.0008, -0.0005, kHalf.z() + kBodyRadius - 0.004);
    rig.settle(hand, turn(Vec3(0, 0, 1), 0.01), 100);
    const Similarity rest = rig.sut.place();
    Random random(7);
    for (int i = 0; i < 60'000; ++i)
    {
        const ToolOutput output =
            rig.step(hand + random.in_cube(1e-4), turn(Vec3(0.1, 0.1, 1), 0.01 + 0.002 * (i % 3)));
        ASSERT_TRUE(rig.sut.sticks()) << i;
        ASSERT_EQ(rig.sut.place().translation_m, rest.translation_m) << i;
        ASSERT_EQ(rig.sut.place().rotation, rest.rotation) << i;
        ASSERT_LT(kinetic_ratio(output), 0.5) << i;
    }
}

TEST(RigidMaterials, a_twist_about_the_normal_sticks_and_slides_by_its_torque)
{
    Material material;
    material.static_friction = 0.4;
    material.dynamic_friction = 0.4;
    Rig rig = box_on_plane(material);
    const Vec3 hand(0, 0, kHalf.z() + kBodyRadius - 0.004);
    rig.settle(hand, Mat3::Identity(), 100);
    // Of four corners that carry the same the friction's torque is at most this.
    const double lever = std::hypot(kHalf.x(), kHalf.y());
    const double most_nm = 0.4 * kBodyStiffness * 0.004 * lever;
    const double arm = kHalf.norm() + kBodyRadius;
    const double slip_rad = most_nm / (kBodyStiffness * arm * arm);

    rig.settle(hand, turn(Vec3(0, 0, 1), 0.9 * slip_rad));
    const Mat3 stuck = rig.sut.place().rotation;
    EXPECT_LE((stuck - Mat3::Identity()).norm(), 1e-4);
    const ToolOutput slid = rig.settle(hand, turn(Vec3(0, 0, 1), 3.0 * slip_rad));
    EXPECT_GT(Eigen::AngleAxisd(slid.proxy_rotation).angle(), slip_rad);
    EXPECT_LE(std::abs(slid.torque_nm.z()), 1.02 * most_nm);
    EXPECT_GE(std::abs(slid.torque_nm.z()), 0.9 * most_nm);
}

TEST(RigidMaterials, an_object_that_moves_takes_along_what_sticks_to_it)
{
    Material material;
    material.static_friction = 0.8;
    material.dynamic_friction = 0.8;
    Rig rig = box_on_plane(material);
    const Vec3 hand(0, 0, kHalf.z() + kBodyRadius - 0.004);
    rig.settle(hand, Mat3::Identity(), 100);
    const Vec3 before = rig.sut.place().translation_m;
    for (int i = 0; i < 100; ++i)
    {
        rig.objects[0].pose.translation_m.x() += 1e-5;
        static_cast<void>(rig.step(hand));
    }
    EXPECT_NEAR(rig.sut.place().translation_m.x() - before.x(), 1e-3, 1e-5);

    const Mat3 turned = rig.sut.place().rotation;
    for (int i = 0; i < 100; ++i)
    {
        rig.objects[0].pose.rotation = turn(Vec3(0, 0, 1), 1e-4) * rig.objects[0].pose.rotation;
        static_cast<void>(rig.step(hand));
    }
    EXPECT_NEAR(Eigen::AngleAxisd(rig.sut.place().rotation * turned.transpose()).angle(), 0.01,
                2e-4);
}

TEST(RigidMaterials, friction_never_drives_the_tool)
{
    Material material;
    material.static_friction = 0.7;
    material.dynamic_friction = 0.5;
    Random random(11);
    for (const ToolCore& core :
         {ToolCore{Box{kHalf}}, ToolCore{Segment{{-0.03, 0, 0}, {0.03, 0, 0}}}})
    {
        Rig rig(tool_of(core), {{cube(0.05), {}, material}, {plane(), {}, material}});
        rig.objects[0].pose.translation_m = Vec3(0, 0, 0.06);
        rig.settle(Vec3(0.2, 0, 0.2));
        Vec3 goal(0.2, 0, 0.2);
        Mat3 rotation = Mat3::Identity();
        Vec3 aim = goal;
        Vec3 axis(0, 0, 1);
        int stuck = 0;
        int slid = 0;
        for (int i = 0; i < 6'000; ++i)
        {
            if (random.one_in(50))
            {
                aim = Vec3(0, 0, 0.06) + random.in_cube(0.12);
                axis = random.in_cube(1.0);
            }
            goal += 0.05 * (aim - goal);
            rotation = turn(axis, 0.01) * rotation;
            const Similarity from = rig.sut.place();
            const Vec3 ahead = goal - from.translation_m;
            const Eigen::AngleAxisd turned(rotation * from.rotation.transpose());

            const ToolOutput output = rig.step(goal, rotation);

            // The hand's springs are stretched by what the force says at most: what holds back
            // never sends the tool the other way.
            ASSERT_GT(rig.distance(), 0.0) << i;
            const double pulled =
                output.force_n.dot(ahead) + output.torque_nm.dot(turned.angle() * turned.axis());
            ASSERT_LE(pulled, 1e-3) << i << ": it was driven on";
            stuck += rig.sut.sticks() ? 1 : 0;
            slid += rig.sut.slides() ? 1 : 0;
        }
        EXPECT_GT(stuck, 100);
        EXPECT_GT(slid, 100);
    }
}

TEST(RigidMaterials, viscosity_drags_a_sliding_and_a_turning_body)
{
    for (const double viscosity : {1.0, 8.0})
    {
        for (const double friction : {0.0, 0.2})
        {
            Material material;
            material.viscosity_n_s_per_m = viscosity;
            material.static_friction = material.dynamic_friction = friction;
            Rig rig = box_on_plane(material);
            rig.takes_steps = true;
            constexpr double kDepth = 0.002;
            constexpr double kSpeed = 0.05;
            const double height_m = rig.sut.place().translation_m.z() - kDepth;
            ToolOutput output;
            for (int i = 0; i < 600; ++i)
            {
                output = rig.step(Vec3(kSpeed * kPeriod_s * i, 0.0, height_m));
            }
            const double drag_n = viscosity * kSpeed + friction * output.force_n.z();
            EXPECT_NEAR(output.force_n.x(), -drag_n, 0.02 * drag_n);
            EXPECT_NEAR(output.force_n.z(), kBodyStiffness * kDepth, 0.02);
            // The hand stands: what was held is let go, without a push beyond.
            for (int i = 0; i < 400; ++i)
            {
                output = rig.step(Vec3(kSpeed * kPeriod_s * 600, 0.0, height_m));
                EXPECT_LE(output.force_n.x(), 1e-3);
            }
            EXPECT_LE(-output.force_n.x(), friction * output.force_n.z() + 2e-3);
        }
    }
    Material honey;
    honey.viscosity_n_s_per_m = 5.0;
    Rig rig = box_on_plane(honey);
    const Vec3 hand = rig.sut.place().translation_m - Vec3(0, 0, 0.002);
    rig.settle(hand, Mat3::Identity(), 50);
    ToolOutput output;
    for (int i = 0; i < 300; ++i)
    {
        output = rig.step(hand, turn(Vec3(0, 0, 1), 1e-3 * i));
    }
    EXPECT_LT(output.torque_nm.z(), -1e-4) << "it turns on corners that drag";
    EXPECT_LT(output.force_n.head<2>().norm(), 0.1 * output.force_n.z());
}

/// Over the stiffness: what bumps add to the spring, at one place and depth.
double bump_energy(const Material& material, const Vec3& at_m, double depth_m)
{
    double height_m = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double turns = at_m[axis] / material.texture_length_m;
        const double t = turns - std::floor(turns);
        height_m += material.texture_height_m * (16.0 * std::pow(t * (1.0 - t), 2) - 0.5);
    }
    const double most_m =
        std::pow(material.texture_length_m, 2) / (64.0 * material.texture_height_m);
    return most_m * std::pow(depth_m / (most_m + depth_m), 2) * height_m;
}

Material bumpy_material()
{
    Material material;
    material.texture_height_m = 6e-5;
    material.texture_length_m = 3e-3;
    return material;
}

TEST(RigidMaterials, a_texture_is_felt_where_the_middle_of_the_body_is)
{
    const Material material = bumpy_material();
    constexpr double kDepth = 1.5e-3;
    double most_n = 0.0;
    for (int i = 0; i < 30; ++i)
    {
        Rig rig = box_on_plane(material);
        const double height_m = rig.sut.place().translation_m.z();
        const Vec3 hand(1.3e-4 * i, 0.0, height_m - kDepth);
        const ToolOutput output = rig.settle(hand, Mat3::Identity(), 200);
        const auto slope_at = [&](double x)
        {
            return (bump_energy(material, Vec3(x + 1e-8, 0.0, output.proxy_m.z()), kDepth) -
                    bump_energy(material, Vec3(x - 1e-8, 0.0, output.proxy_m.z()), kDepth)) /
                   2e-8;
        };
        double proxy_m = hand.x();
        for (int round = 0; round < 100; ++round)
        {
            proxy_m += 0.5 * (hand.x() - slope_at(proxy_m) - proxy_m);
        }
        EXPECT_NEAR(output.proxy_m.x(), proxy_m, 2e-6) << i;
        EXPECT_NEAR(output.force_n.x(), kBodyStiffness * (proxy_m - hand.x()), 1e-3) << i;
        const double rise = (bump_energy(material, output.proxy_m, kDepth + 1e-8) -
                             bump_energy(material, output.proxy_m, kDepth - 1e-8)) /
                            2e-8;
        EXPECT_NEAR(output.force_n.z(), kBodyStiffness * (kDepth + rise), 1e-2) << i;
        EXPECT_GT(output.stiffness_n_per_m, kBodyStiffness);
        most_n = std::max(most_n, std::abs(output.force_n.x()));
    }
    EXPECT_GT(most_n, 0.005) << "bumps that are felt";
}

/// Once round a closed way of the hand and a closed turn: what force and torque did on the hand.
double work_of_turning_rounds(const Material& material, std::uint64_t seed)
{
    Random random(seed);
    const double wide_m = random.between(5e-4, 2e-3);
    const double phase = random.between(0.0, 6.0);
    const double tilt_rad = random.between(0.005, 0.02);
    Rig rig = box_on_plane(material);
    rig.takes_steps = true;
    const double height_m = rig.sut.place().translation_m.z();
    constexpr int kRound = 4'000;
    const auto hand_of = [&](int step)
    {
        const double angle = 2.0 * std::numbers::pi * step / kRound;
        const Mat3 rotation = turn(Vec3(1, 0.4, 0), tilt_rad * std::sin(angle + 1.0)) *
                              turn(Vec3(0, 0, 1), 0.05 * std::cos(angle));
        return hand_at(Vec3(wide_m * std::cos(angle), wide_m * std::sin(angle),
                            height_m - 1e-3 + 5e-4 * std::sin(angle + phase)),
                       rotation);
    };
    for (int i = 0; i < 200; ++i)
    {
        (void)rig.step(hand_of(0));
    }
    double work_j = 0.0;
    ToolOutput last = rig.step(hand_of(0));
    ToolGoal before = hand_of(0);
    for (int step = 1; step <= 2 * kRound; ++step)
    {
        const ToolGoal hand = hand_of(step);
        const ToolOutput now = rig.step(hand);
        const Eigen::AngleAxisd turned(hand.rotation * before.rotation.transpose());
        work_j += 0.5 * (now.force_n + last.force_n).dot(hand.position_m - before.position_m) +
                  0.5 * (now.torque_nm + last.torque_nm).dot(turned.angle() * turned.axis());
        last = now;
        before = hand;
    }
    return work_j;
}

TEST(RigidMaterials, a_texture_makes_no_energy_on_closed_ways_and_turns)
{
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
    {
        const double smooth_j = work_of_turning_rounds({}, seed);
        const double bumpy_j = work_of_turning_rounds(bumpy_material(), seed);
        std::printf("work on the hand, twice round: %.3g J smooth, %.3g J with bumps\n", smooth_j,
                    bumpy_j);
        EXPECT_LT(bumpy_j, 1e-7) << seed;
    }
}

} // namespace tactus::test
