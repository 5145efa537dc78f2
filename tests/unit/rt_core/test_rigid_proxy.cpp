// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/angular_stiffness.hpp"
#include "tests/unit/rt_core/rigid_tool_rig.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test
{

namespace
{

/// Answer of a complete query.
std::unique_ptr<OwnedSurface> exact_surface()
{
    auto surface = std::make_unique<OwnedSurface>();
    surface->answer.kind = AnswerKind::exact;
    return surface;
}

/// Least distance of the core on its path: its centre moves straight while it rotates about one
/// axis.
double least_on_way(const Rig& rig, const ToolCore& core, const Similarity& from)
{
    const Similarity& to = rig.sut.place();
    const Vec3 center = PlacedCore(core, {}).center();
    const Vec3 way = to.local_to_world(center) - from.local_to_world(center);
    const Eigen::AngleAxisd turned(to.rotation * from.rotation.transpose());
    double least = std::numeric_limits<double>::infinity();
    for (const double share : {0.2, 0.4, 0.6, 0.8, 1.0})
    {
        const Mat3 rotation =
            Eigen::AngleAxisd(share * turned.angle(), turned.axis()).toRotationMatrix() *
            from.rotation;
        const Vec3 at = from.local_to_world(center) + share * way - rotation * center;
        least = std::min(least, rig.distance_at({rotation, at, 1.0}));
    }
    return least;
}

/// Flat square of 0.2 m in cells of two triangles each, with inner corners displaced in its plane.
TriangleList flat_mesh(double cell_m)
{
    const int cells = static_cast<int>(0.2 / cell_m);
    const auto corner = [&](int i, int j)
    {
        const double shift = i % 3 == 1 && j % 2 == 1 ? 0.3 * cell_m : 0.0;
        return to_float(Vec3(-0.1 + cell_m * i + shift, -0.1 + cell_m * j - 0.5 * shift, 0.0));
    };
    TriangleList triangles;
    for (int i = 0; i < cells; ++i)
    {
        for (int j = 0; j < cells; ++j)
        {
            triangles.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
            triangles.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
        }
    }
    return triangles;
}

/// Wall of a cylinder around the z axis, with `facets` facets whose middles are at the radius, each
/// in `rings` pieces.
TriangleList tube(double radius_m, double half_m, int facets, int rings)
{
    TriangleList list;
    const double corner_m = radius_m / std::cos(std::numbers::pi / facets);
    for (int i = 0; i < facets; ++i)
    {
        const auto at = [&](int k, double z)
        {
            const double angle = 2.0 * std::numbers::pi * k / facets;
            return Vec3(corner_m * std::cos(angle), corner_m * std::sin(angle), z);
        };
        for (int ring = 0; ring < rings; ++ring)
        {
            const double from = half_m * (2.0 * ring / rings - 1.0);
            const double to = half_m * (2.0 * (ring + 1) / rings - 1.0);
            add_square(list, at(i, from), at(i + 1, from), at(i + 1, to), at(i, to));
        }
    }
    return list;
}

/// Box at rest on a plane, just touching it.
Rig box_on_plane(const Material& material)
{
    Rig rig = on_plane(Box{kHalf}, material);
    rig.settle(Vec3(0, 0, 0.05));
    rig.settle(Vec3(0, 0, kHalf.z() + kRigidRadius - 1e-5));
    return rig;
}

} // namespace

TEST(RigidProxy, comes_to_rest_on_what_held_it_where_it_is_told_of_one_point_at_a_time)
{
    Rig rig = on_plane(Box{kHalf});
    rig.tells_corners = false;
    rig.settle(Vec3(0, 0, 0.05));
    const Mat3 tilted = turn(Vec3(1, 2, 0), 0.02);
    rig.settle(Vec3(0, 0, -0.004), tilted, 100);
    for (int i = 0; i < 100; ++i)
    {
        const Vec3 before = rig.sut.place().translation_m;
        const ToolOutput output = rig.step(Vec3(0, 0, -0.004), tilted);
        ASSERT_LE((output.proxy_m - before).norm(), 1e-4 * kRigidRadius) << i;
        ASSERT_NEAR(rig.distance(), kRigidRadius, 0.01 * kRigidRadius) << i;
    }
}

TEST(RigidProxy, slides_and_turns_over_the_seams_of_a_mesh_without_drag)
{
    const std::array<Vec3, 5> corners{
        {{0.02, 0.0, 0.0}, {-0.01, 0.02, 0.0}, {-0.01, -0.02, 0.0}, {0, 0, 0.02}, {0.01, 0, 0.03}}};
    const std::array<std::pair<ToolCore, double>, 3> tools{
        {{Box{kHalf}, kHalf.z()},
         {Segment{{-0.03, 0, 0}, {0.03, 0, 0}}, 0.0},
         {Hull::create(corners).value(), 0.0}}};
    for (const auto& [core, height_m] : tools)
    {
        for (const double cell_m : {0.02, 0.01})
        {
            Rig rig(tool_of(core), {{flat_mesh(cell_m), {}, {}}});
            rig.takes_steps = true;
            const double pressed_m = height_m + kRigidRadius - 0.002; // 1 N.
            rig.settle(Vec3(-0.02, 0, 0.05));
            rig.settle(Vec3(-0.02, 0, pressed_m));
            for (int frame = 0; frame < 200; ++frame)
            {
                const Vec3 goal(-0.02 + 2e-4 * frame, 8e-5 * frame, pressed_m);
                const ToolOutput output = rig.step(goal, turn(Vec3(0, 0, 1), 4e-3 * frame));
                const auto told = [&]
                { return std::to_string(cell_m) + ", " + std::to_string(frame); };
                ASSERT_NEAR(output.force_n.z(), 1.0, 5e-3) << told();
                ASSERT_LE(output.force_n.head<2>().norm(), 5e-3) << told();
                ASSERT_GE(rig.distance(), kRigidRadius * (1.0 - 1e-6)) << told();
            }
        }
    }
}

TEST(RigidProxy, pressed_at_an_angle_turns_back_what_the_surface_turns)
{
    for (const double angle : {-0.3, -0.02, 0.02, 0.3})
    {
        Rig rig = on_plane(Box{kHalf});
        rig.settle(Vec3(0, 0, 0.1));
        const Mat3 tilted = turn(Vec3(0, 1, 0), angle);

        const ToolOutput output = rig.settle(Vec3(0, 0, -0.01), tilted);

        // Contacts below only: a force along z, and a lever no longer than the tool.
        EXPECT_TRUE(output.in_contact);
        EXPECT_GT(output.force_n.z(), 0.0);
        EXPECT_LE(Vec3(output.force_n.x(), output.force_n.y(), 0.0).norm(), 1e-3);
        EXPECT_LT(output.torque_nm.y() * angle, 0.0) << "back towards where the surface has it";
        EXPECT_LE(std::abs(output.torque_nm.x()), 1e-4);
        EXPECT_LE(std::abs(output.torque_nm.y()),
                  output.force_n.z() * (kHalf.x() + kHalf.z()) + 1e-6);
        EXPECT_NEAR(rig.distance(), kRigidRadius, 1e-3 * kRigidRadius);
        // The coupling's two springs: torque and force determine the proxy's pose.
        const double arm = kHalf.norm() + kRigidRadius;
        const Eigen::AngleAxisd held(output.proxy_rotation * tilted.transpose());
        const Vec3 torque = kRigidStiffness * arm * arm * held.angle() * held.axis();
        EXPECT_LE((output.torque_nm - torque).norm(), 0.02 * torque.norm() + 1e-6) << angle;
        EXPECT_LE((output.force_n - kRigidStiffness * (output.proxy_m - Vec3(0, 0, -0.01))).norm(),
                  0.02 * output.force_n.norm());
    }
}

TEST(RigidProxy, force_and_torque_are_clamped_by_one_gain)
{
    ToolSpec spec = tool_of(Box{kHalf});
    const auto pressed_with = [&spec](double force_max_n, double torque_max_nm)
    {
        spec.force_max_n = force_max_n;
        spec.torque_max_nm = torque_max_nm;
        Rig rig(spec, {{plane(), {}}});
        rig.settle(Vec3(0, 0, 0.1));
        return rig.settle(Vec3(0, 0, -0.05), turn(Vec3(0, 1, 0), 0.5));
    };
    const ToolOutput whole = pressed_with(1e3, 1e3);
    const ToolOutput weak = pressed_with(2.0, 1e3);
    const ToolOutput unturned = pressed_with(1e3, 0.01);
    const ToolOutput of_a_point = pressed_with(2.0, 0.0);

    const double arm_m = whole.torque_nm.norm() / whole.force_n.norm();
    EXPECT_NEAR(weak.force_n.norm(), 2.0, 1e-12);
    EXPECT_NEAR(weak.torque_nm.norm(), 2.0 * arm_m, 1e-6);
    EXPECT_NEAR(unturned.torque_nm.norm(), 0.01, 1e-12);
    EXPECT_NEAR(unturned.force_n.norm(), 0.01 / arm_m, 1e-6);
    EXPECT_NEAR(of_a_point.force_n.norm(), 2.0, 1e-12);
    EXPECT_EQ(of_a_point.torque_nm, Vec3(0, 0, 0));
}

TEST(RigidProxy, never_pulls_and_its_core_never_crosses_a_surface)
{
    const std::vector<Vec3> spike{
        {0, 0, -0.04}, {0.01, 0, 0.02}, {-0.01, 0.01, 0.02}, {0, -0.01, 0.02}};
    const std::array<ToolCore, 3> cores{Box{kHalf}, Segment{{-0.03, 0, 0}, {0.03, 0, 0}},
                                        Hull::create(spike).value()};
    Random random(2);
    for (const ToolCore& core : cores)
    {
        Rig rig(tool_of(core), {{cube(0.05), {}}, {plane(), {}}});
        rig.objects[0].pose.translation_m = Vec3(0, 0, 0.07);
        rig.settle(Vec3(0.2, 0, 0.2));
        Vec3 goal(0.2, 0, 0.2);
        Mat3 rotation = Mat3::Identity();
        Vec3 aim = goal;
        Vec3 axis(0, 0, 1);
        int contacts = 0;
        for (int i = 0; i < 6'000; ++i)
        {
            if (random.one_in(50))
            {
                aim = Vec3(0, 0, 0.06) + random.in_cube(0.12);
                axis = random.in_cube(1.0);
            }
            goal += 0.05 * (aim - goal);
            rotation = turn(axis, 0.03) * rotation;
            const Similarity before = rig.sut.place();
            const double room = rig.distance();

            const ToolOutput output = rig.step(goal, rotation);

            ASSERT_TRUE(output.force_n.allFinite() && output.torque_nm.allFinite()) << i;
            ASSERT_GT(rig.distance(), 0.0) << i;
            ASSERT_GE(least_on_way(rig, core, before), 0.0999 * room) << i;
            ASSERT_GE(
                output.force_n.dot(output.proxy_m - goal) +
                    output.torque_nm.dot(
                        Eigen::AngleAxisd(output.proxy_rotation * rotation.transpose()).angle() *
                        Eigen::AngleAxisd(output.proxy_rotation * rotation.transpose()).axis()),
                -1e-2)
                << i << ": it gave energy away";
            contacts += output.in_contact ? 1 : 0;
        }
        EXPECT_GT(contacts, 1'000);
    }
}

TEST(RigidProxy, between_brackets_goes_no_farther_than_they_allow)
{
    Rig rig = on_plane(Box{kHalf});
    rig.settle(Vec3(0, 0, 0.05));
    rig.kind = AnswerKind::bounded;
    rig.lower_share = 0.5;
    for (int i = 0; i < 100; ++i)
    {
        const Vec3 before = rig.sut.place().translation_m;
        const double room = std::max(0.0, 0.5 * rig.distance() - kRigidRadius);
        const ToolOutput output = rig.step(Vec3(0, 0, -0.05));
        ASSERT_LE((output.proxy_m - before).norm(), room + 1e-15) << i;
    }
    EXPECT_GT(rig.distance(), kRigidRadius);
}

TEST(RigidProxy, that_starts_across_a_surface_is_where_the_hand_is_until_it_is_clear)
{
    Rig rig = on_plane(Box{kHalf});
    for (const double z : {0.0, 0.002, -0.003})
    {
        const ToolOutput output = rig.step(Vec3(0, 0, z));
        EXPECT_EQ(output.proxy_m, Vec3(0, 0, z));
        EXPECT_EQ(output.force_n, Vec3(0, 0, 0));
    }
    rig.settle(Vec3(0, 0, 0.03));
    EXPECT_NEAR(rig.settle(Vec3(0, 0, 0.0)).proxy_m.z(), 0.012, 1e-7);
}

TEST(RigidProxy, is_not_run_over_by_an_object_that_turns_and_leaps)
{
    for (const double height_m : {0.009, 0.0125}) // Pressed, and only near.
    {
        Rig rig = on_plane(Box{kHalf});
        const Vec3 over(0.2, 0, height_m);
        rig.settle(Vec3(0, 0, 0.05));
        rig.settle(over);
        Random random(3);
        for (int i = 0; i < 200; ++i)
        {
            ObjectPose& pose = rig.objects[0].pose;
            const Vec3 axis = random.in_cube(1.0);
            pose.rotation = turn(axis, random.between(0.0, 0.05)) * pose.rotation;
            pose.translation_m += random.in_cube(0.004);
            const ToolOutput output = rig.step(to_world(pose, over), pose.rotation);
            ASSERT_FALSE(output.halted) << i;
            ASSERT_FALSE(output.over_constrained) << i;
            ASSERT_GT(rig.distance(), 0.0) << i;
            ASSERT_GT(to_model(pose, output.proxy_m).z(), 0.0)
                << i; // The side is the previous one.
        }
    }
}

TEST(RigidProxy, held_by_an_object_that_moves_is_not_taken_through_one_that_stands)
{
    for (const double leap_m : {0.0005, 0.003, 0.02})
    {
        Rig rig(tool_of(Box{kHalf}), {{plane(), {}}, {plane(), {}}});
        rig.objects[1].pose.translation_m.z() = 0.03;
        rig.settle(Vec3(0, 0, 0.015));
        bool was_over_constrained = false;
        for (int i = 0; i < 60; ++i)
        {
            rig.objects[0].pose.translation_m.z() += leap_m;
            const ToolOutput output = rig.step(Vec3(0, 0, 0.0));
            was_over_constrained = was_over_constrained || output.over_constrained;
            ASSERT_TRUE(was_over_constrained || rig.distance() > 0.0) << leap_m << ", " << i;
        }
        EXPECT_TRUE(was_over_constrained);
    }
}

TEST(RigidProxy, that_an_object_came_over_is_given_up_when_its_force_has_faded)
{
    Rig rig(tool_of(Box{kHalf}), {{plane(), {}}, {plane(), {}}});
    rig.objects[1].pose.translation_m.z() = 0.03;
    rig.settle(Vec3(0, 0, 0.015));
    rig.settle(Vec3(0, 0, 0.0));
    rig.objects[0].pose.translation_m.z() = 0.025;

    const ToolOutput over = rig.step(Vec3(0, 0, 0.0));
    EXPECT_TRUE(over.halted);
    EXPECT_TRUE(over.over_constrained);
    const ToolOutput output = rig.settle(Vec3(0, 0, 0.1));

    EXPECT_EQ(output.proxy_m, Vec3(0, 0, 0.1));
    EXPECT_EQ(output.force_n, Vec3(0, 0, 0));
}

/// Sphere's proxy at the origin with given contacts with one object.
class RegionSphere
{
public:
    ToolOutput step(const std::vector<Contact>& contacts, const Vec3& goal)
    {
        TouchReport touches;
        for (const Contact& contact : contacts)
        {
            (touches.nearest.full() ? touches.corners : touches.nearest).push_back(contact);
        }
        touches.is_truncated = is_truncated;
        const Material material;
        ProxyMemory memory;
        PlacedSurface placed{&pose_, surface_.get(), &material, 0.0, 0.0, lower_m, &touches};
        placed.memory = &memory;
        sut.see(hand_at(goal));
        return sut.respond(hand_at(goal), {&placed, 1}, kInfinity);
    }
    /// Contact of the sphere's core with a surface at this distance.
    [[nodiscard]] Contact contact(const Vec3& normal, double distance) const
    {
        const Vec3 at = sut.place().translation_m;
        return {FaceId{}, TriangleFeature::interior, distance, at, at - distance * normal, normal,
                FaceId{}};
    }

private:
    ObjectPose pose_;
    std::unique_ptr<OwnedSurface> surface_ = exact_surface();
    RigidProxy::Planes planes_;

public:
    RigidProxy sut{tool_of(Segment{{0, 0, -0.01}, {0, 0, 0.01}}), planes_};
    bool is_truncated{false};
    double lower_m{kRigidRadius}; ///< Reported lower bound of all distances.
};

/// Direction i of `count` on a cone, none between others.
Vec3 on_cone(std::size_t i, std::size_t count)
{
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    return Vec3(std::cos(angle), std::sin(angle), 1.5).normalized();
}

TEST(RigidProxy, remembers_as_many_holds_as_the_limit_and_says_when_it_forgets_one)
{
    RegionSphere sphere;
    static_cast<void>(sphere.step({}, Vec3(0, 0, 0)));
    for (std::size_t i = 0; i <= kMaxHolds; ++i)
    {
        const Vec3 normal = on_cone(i, kMaxHolds + 1);
        const ToolOutput output =
            sphere.step({sphere.contact(normal, kRigidRadius)},
                        sphere.sut.place().translation_m - kRigidRadius * normal);
        ASSERT_TRUE(output.in_contact) << i;
        EXPECT_EQ(sphere.sut.exceeds_capacity(), i == kMaxHolds) << i;
    }
}

TEST(RigidProxy, takes_as_many_planes_as_the_limit_and_says_when_it_leaves_one_out)
{
    for (const std::size_t count : {std::size_t{kMaxHalfSpaces}, std::size_t{kMaxHalfSpaces} + 1})
    {
        RegionSphere sphere;
        static_cast<void>(sphere.step({}, Vec3(0, 0, 0)));
        std::vector<Contact> contacts;
        for (std::size_t i = 1; i < count; ++i)
        {
            contacts.push_back(sphere.contact(on_cone(i, count), 1.5 * kRigidRadius));
        }
        // Holding contacts are kept in any order of reports: then only one more is added from those
        // that held.
        static_cast<void>(
            sphere.step({sphere.contact(on_cone(0, count), kRigidRadius)},
                        sphere.sut.place().translation_m - kRigidRadius * on_cone(0, count)));
        EXPECT_FALSE(sphere.sut.exceeds_capacity());
        const ToolOutput output = sphere.step(contacts, sphere.sut.place().translation_m -
                                                            kRigidRadius * on_cone(0, count));
        EXPECT_TRUE(output.in_contact);
        EXPECT_EQ(sphere.sut.exceeds_capacity(), count > kMaxHalfSpaces);
    }
}

TEST(RigidProxy, that_is_not_told_of_all_touches_fades_where_its_radius_is_all_but_used_up)
{
    for (const bool is_truncated : {false, true})
    {
        for (const double left : {0.2, 0.05})
        {
            RegionSphere sphere;
            static_cast<void>(sphere.step({}, Vec3(0, 0, 0)));
            sphere.is_truncated = is_truncated;
            sphere.lower_m = left * kRigidRadius;
            const ToolOutput output =
                sphere.step({sphere.contact(Vec3(0, 0, 1), kRigidRadius)}, Vec3(0, 0, -0.1));
            EXPECT_TRUE(output.in_contact);
            EXPECT_EQ(sphere.sut.exceeds_capacity(), is_truncated);
            EXPECT_EQ(output.over_constrained, is_truncated && left < 0.1) << left;
        }
    }
}

TEST(RigidProxy, without_a_radius_keeps_a_skin)
{
    Rig rig(tool_of(Box{kHalf}, 0.0), {{plane(), {}}});
    rig.settle(Vec3(0, 0, 0.05));

    const ToolOutput output = rig.settle(Vec3(0, 0, -0.004));

    const double skin = kLeastSkin * kHalf.norm();
    EXPECT_NEAR(output.proxy_m.z(), kHalf.z() + skin, 0.01 * skin);
    EXPECT_NEAR(rig.settle(Vec3(0.02, 0, -0.004), Mat3::Identity(), 900).proxy_m.x(), 0.02, 1e-4);
}

TEST(RigidProxy, of_two_objects_each_pushes_by_its_own_stiffness)
{
    Material soft;
    soft.stiffness_n_per_m = 100.0;
    // Corner of two walls; the hand is equally deep behind each of them.
    Rig rig(tool_of(Segment{{0, 0, -0.01}, {0, 0, 0.01}}), {{plane(), {}}, {plane(), {}, soft}});
    rig.objects[1].pose.rotation = turn(Vec3(0, 1, 0), std::numbers::pi / 2.0);
    rig.settle(Vec3(0.03, 0, 0.05));

    const ToolOutput output = rig.settle(Vec3(-0.003, 0, 0.007));

    const Vec3 between = output.proxy_m - Vec3(-0.003, 0, 0.007);
    EXPECT_NEAR(output.force_n.x(), 100.0 * between.x(), 1e-3);
    EXPECT_NEAR(output.force_n.z(), kRigidStiffness * between.z(), 1e-2);
}

TEST(RigidProxy, the_angular_stiffness_is_what_is_set)
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
        EXPECT_NEAR(rig.distance(), kRigidRadius, 2e-3 * kRigidRadius);
    }
    ToolSpec unset = tool_of(Box{kHalf});
    const double arm = kHalf.norm() + kRigidRadius;
    EXPECT_NEAR(angular_stiffness_nm_per_rad(unset), kRigidStiffness * arm * arm, 1e-12);
    EXPECT_NEAR(angular_lever_m(unset), arm, 1e-12);
    unset.core = PointCore{};
    EXPECT_EQ(angular_stiffness_nm_per_rad(unset), 0.0);
    EXPECT_EQ(angular_lever_m(unset), 0.0);
}

TEST(RigidProxy, damping_brakes_a_turn_and_an_object_that_comes_nearer)
{
    Material material;
    material.damping_n_s_per_m = 8.0;
    Rig rig = box_on_plane(material);
    ProxyGoal hand = hand_at(Vec3(0, 0, 0.008));
    rig.settle(hand.position_m);
    const double still_n = rig.step(hand).force_n.z();
    // A rotation moves one side in as fast as the other one out; contact on both is damped.
    hand.spin_rad_per_s = Vec3(0, 1.0, 0);
    EXPECT_LT(rig.step(hand).torque_nm.y(), -1e-4);
    hand.spin_rad_per_s = Vec3(0, 0, 0);
    rig.objects[0].pose.translation_m.z() += 1e-5;
    EXPECT_NEAR(rig.step(hand).force_n.z(), still_n + 8.0 * 0.01 + kRigidStiffness * 1e-5, 0.02);
}

TEST(RigidProxy, a_twist_about_the_normal_sticks_and_slides_by_its_torque)
{
    Material material;
    material.static_friction = 0.4;
    material.dynamic_friction = 0.4;
    Rig rig = box_on_plane(material);
    const Vec3 hand(0, 0, kHalf.z() + kRigidRadius - 0.004);
    rig.settle(hand, Mat3::Identity(), 100);
    // The friction's torque of four equally loaded corners is at most this.
    const double lever = std::hypot(kHalf.x(), kHalf.y());
    const double most_nm = 0.4 * kRigidStiffness * 0.004 * lever;
    const double arm = kHalf.norm() + kRigidRadius;
    const double slip_rad = most_nm / (kRigidStiffness * arm * arm);

    rig.settle(hand, turn(Vec3(0, 0, 1), 0.9 * slip_rad));
    const Mat3 stuck = rig.sut.place().rotation;
    EXPECT_LE((stuck - Mat3::Identity()).norm(), 1e-4);
    const ToolOutput slid = rig.settle(hand, turn(Vec3(0, 0, 1), 3.0 * slip_rad));
    EXPECT_GT(Eigen::AngleAxisd(slid.proxy_rotation).angle(), slip_rad);
    EXPECT_LE(std::abs(slid.torque_nm.z()), 1.02 * most_nm);
    EXPECT_GE(std::abs(slid.torque_nm.z()), 0.9 * most_nm);
}

TEST(RigidProxy, an_object_that_turns_takes_along_what_sticks_to_it)
{
    Material material;
    material.static_friction = 0.8;
    material.dynamic_friction = 0.8;
    Rig rig = box_on_plane(material);
    const Vec3 hand(0, 0, kHalf.z() + kRigidRadius - 0.004);
    rig.settle(hand, Mat3::Identity(), 100);
    const Mat3 before = rig.sut.place().rotation;
    for (int i = 0; i < 100; ++i)
    {
        rig.objects[0].pose.rotation = turn(Vec3(0, 0, 1), 1e-4) * rig.objects[0].pose.rotation;
        static_cast<void>(rig.step(hand));
    }
    EXPECT_NEAR(turned_between(before, rig.sut.place().rotation).norm(), 0.01, 2e-4);
}

TEST(RigidProxy, friction_never_drives_the_tool)
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

            // The hand's springs are stretched at most by the force: the constraints never push the
            // tool backwards.
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

TEST(RigidProxy, viscosity_drags_a_turning_body)
{
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

TEST(RigidProxy, force_and_torque_change_by_no_more_than_the_stiffness_times_the_motion)
{
    // The box moves over a cylinder of facets, pressed and rotated by a hand that never stops.
    constexpr int kFacets = 48;
    ToolSpec spec = tool_of(Box{kHalf});
    Rig rig(spec, {{tube(0.05, 0.06, kFacets, 12), {}}});
    rig.takes_steps = true;
    rig.objects[0].pose.rotation = turn(Vec3(0, 1, 0), std::numbers::pi / 2.0);
    rig.settle(Vec3(0, 0, 0.09), Mat3::Identity(), 50);
    const double arm = kHalf.norm() + kRigidRadius;
    const double facet = 2.0 * std::numbers::pi / kFacets;
    ToolOutput last;
    Vec3 last_hand(0, 0, 0);
    Mat3 last_turn = Mat3::Identity();
    Similarity last_place;
    int contacts = 0;
    for (int i = 0; i < 1'500; ++i)
    {
        const double t = 2e-3 * i;
        const Vec3 hand(0.02 * std::sin(t), 0.02 * std::sin(1.7 * t), 0.058);
        const Mat3 turned = turn(Vec3(1, 0.3, 0.2), 0.2 * std::sin(2.3 * t));
        const ToolOutput output = rig.step(hand, turned);
        const Similarity place = rig.sut.place();
        if (i > 200 && last.in_contact && output.in_contact)
        {
            const auto length = [arm](const Vec3& way, const Mat3& from, const Mat3& to)
            { return way.norm() + arm * Eigen::AngleAxisd(to * from.transpose()).angle(); };
            const double moved = length(hand - last_hand, last_turn, turned) +
                                 length(place.translation_m - last_place.translation_m,
                                        last_place.rotation, place.rotation);
            // Between facets: its angle, and the lever that changes by its width.
            const double facet_n = facet * output.force_n.norm();
            ASSERT_LE((output.force_n - last.force_n).norm(), kRigidStiffness * moved + facet_n)
                << i;
            ASSERT_LE((output.torque_nm - last.torque_nm).norm(),
                      arm * (kRigidStiffness * moved + facet_n) + 0.05 * facet_n)
                << i;
            ++contacts;
        }
        last = output;
        last_hand = hand;
        last_turn = turned;
        last_place = place;
    }
    EXPECT_GT(contacts, 1'000);
}

} // namespace tactus::test
