// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Force and torque of rigid tools at rest on encoded models, streamed and refined by whole frames,
/// compared with a brute-force search over the source's faces (rest_oracle.hpp).

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/rest_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr Springs kSprings{500.0, 1.0};
constexpr int kFramesToRest = 400;

Mat3 rotation_about(const Vec3& axis, double angle)
{
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

Vec3 origin_of(const TestModel& model)
{
    return {model.origin_m[0], model.origin_m[1], model.origin_m[2]};
}

/// Hand that moves from one place to another, in the source's frame, and stays.
struct Press
{
    Vec3 from_m{0.0, 0.0, 0.0};
    Vec3 to_m{0.0, 0.0, 0.0};
    Mat3 from{Mat3::Identity()};
    Mat3 to{Mat3::Identity()};
};

struct Errors
{
    double force{0.0}; ///< Error as a share of the force.
    /// Error as a share of the torque, or of the force times the tool's size if that is greater.
    double torque{0.0};
    int presses{0};
};

class RigidRest : public testing::Test
{
protected:
    static FrameRig rig_of(const SolidCore& tool, const TestModel& model)
    {
        RigOptions options;
        options.pool_bytes = std::size_t{32} << 20U;
        ToolSpec spec;
        spec.radius_m = tool.radius_m;
        spec.core = tool.core;
        spec.stiffness_n_per_m = kSprings.stiffness_n_per_m;
        spec.angular_stiffness_nm_per_rad = kSprings.stiffness_nm_per_rad;
        spec.force_max_n = 100.0;
        spec.torque_max_nm = 100.0;
        options.tools = {spec};
        std::vector<const TestModel*> models{&model};
        if (tool.mesh != nullptr)
        {
            models.push_back(tool.mesh);
        }
        return FrameRig(models, options);
    }
    void press(const SolidCore& tool, const TestModel& model, const Press& hand)
    {
        SCOPED_TRACE(tool.name + " on " + model.name + ", press " + std::to_string(errors.presses));
        FrameRig rig = rig_of(tool, model);
        const Vec3 origin = origin_of(model);
        const Vec3 axis_angle = [&]
        {
            const Eigen::AngleAxisd way(hand.to * hand.from.transpose());
            return Vec3(way.angle() * way.axis());
        }();
        ToolState state;
        ToolOutput rest;
        for (int i = 0; i < kFramesToRest + 200; ++i)
        {
            const double share = std::clamp((i - 50) / 150.0, 0.0, 1.0);
            const double angle = share * axis_angle.norm();
            state.position_m = hand.from_m + share * (hand.to_m - hand.from_m) - origin;
            state.rotation =
                angle > 0.0 ? Mat3(rotation_about(axis_angle, angle) * hand.from) : hand.from;
            rest = rig.step(std::span(&state, 1), {}).tools[0];
        }
        ASSERT_TRUE(rest.in_contact && !rest.halted && !rest.over_constrained);
        EXPECT_EQ(rest.lag_m, 0.0);

        const Rest truth =
            rest_of(tool, model.faces, kSprings, {state.rotation, state.position_m, 1.0},
                    {rest.proxy_rotation, rest.proxy_m, 1.0});

        double size_m = 0.0;
        for (const Triangle& face : tool.faces)
        {
            size_m = std::max({size_m, face[0].norm(), face[1].norm(), face[2].norm()});
        }
        size_m += tool.radius_m;
        ASSERT_GT(truth.force_n.norm(), 0.1);
        ASSERT_LT(truth.deepest_m, 1e-6) << "the oracle's own";
        const double force = (rest.force_n - truth.force_n).norm() / truth.force_n.norm();
        const double torque = (rest.torque_nm - truth.torque_nm).norm() /
                              std::max(truth.torque_nm.norm(), truth.force_n.norm() * size_m);
        errors.force = std::max(errors.force, force);
        errors.torque = std::max(errors.torque, torque);
        ++errors.presses;
    }
    void tell(const std::string& what) const
    {
        std::printf("%s: %d presses, force off by %.2g of it at most, torque by %.2g\n",
                    what.c_str(), errors.presses, errors.force, errors.torque);
    }

    Errors errors;
};

SolidCore pin(double radius_m, double half_m)
{
    return segment_core("capsule", {{0, 0, -half_m}, {0, 0, half_m}}, radius_m);
}

} // namespace

TEST_F(RigidRest, a_box_and_a_capsule_on_a_plate_and_over_its_edge)
{
    const TestModel& plate = test_model("rest-plate", make_shape(Shape::plate, 2'000).value(), 100);
    const SolidCore box = box_core("box", Vec3(0.012, 0.008, 0.004), 0.001);
    for (const double tilt : {0.0, 0.2, 0.7})
    {
        const Mat3 turned = rotation_about(Vec3(0.3, 1, 0.2), tilt);
        for (const double x_m : {0.05, 0.098}) // Places on the top, and over its edge.
        {
            for (const SolidCore& tool : {box, pin(0.002, 0.012)})
            {
                press(tool, plate, {{x_m, 0.043, 0.04}, {x_m, 0.043, 0.01}, turned, turned});
            }
        }
    }
    tell("a plate");
    EXPECT_LT(errors.force, 5e-4);
    EXPECT_LT(errors.torque, 5e-3);
}

TEST_F(RigidRest, a_peg_with_a_fifth_of_a_millimetre_of_room)
{
    const TestModel& socket =
        test_model("rest-socket", make_shape(Shape::socket, 2'000).value(), 100);
    for (const double heading : {0.3, 2.5})
    {
        const Vec3 aside = 0.003 * Vec3(std::cos(heading), std::sin(heading), 0.0);
        press(pin(0.01, 0.008), socket, {{0, 0, 0}, aside});
        press(pin(0.01, 0.008), socket,
              {{0, 0, 0},
               0.2 * aside,
               Mat3::Identity(),
               rotation_about(Vec3(0, 0, 1).cross(aside), 0.15)});
    }
    tell("a socket");
    EXPECT_LT(errors.force, 1e-3);
    EXPECT_LT(errors.torque, 1e-3);
}

TEST_F(RigidRest, in_a_tight_fit_it_follows_late_and_tells_by_how_much)
{
    const TestModel& socket =
        test_model("rest-socket", make_shape(Shape::socket, 2'000).value(), 100);
    const TestModel& peg = test_model("rest-pin", make_shape(Shape::peg, 600).value(), 100);
    const Vec3 origin = origin_of(socket);
    constexpr double kJump_m = 0.01;
    for (const SolidCore& tool : {pin(0.01, 0.008), mesh_core("mesh", peg, 1e-4)})
    {
        SCOPED_TRACE(tool.name);
        FrameRig rig = rig_of(tool, socket);
        ToolState state;
        const auto step = [&](const Vec3& at_m)
        {
            state.position_m = at_m - origin;
            return rig.step(std::span(&state, 1), {}).tools[0];
        };
        const Vec3 inside_m(0.0, 0.0, tool.mesh != nullptr ? 0.011 : 0.0);
        const Vec3 leans_m = inside_m + Vec3(0.001, 0.0, 0.0);
        for (int i = 0; i < 300; ++i)
        {
            step(inside_m + std::min(1.0, i / 200.0) * (leans_m - inside_m));
        }
        const Vec3 jumped_m = leans_m + Vec3(0.0, 0.0, kJump_m);
        int late = 0;
        double longest_m = 0.0;
        ToolOutput output = step(jumped_m);
        for (int i = 0; i < 200; ++i)
        {
            const double way_m = jumped_m.z() - (output.proxy_m.z() + origin.z());
            // The lag is that of the tool's point with the longest path, rotation included.
            EXPECT_LE(output.lag_m, 1.25 * std::abs(way_m) + 5e-4) << i;
            EXPECT_TRUE(output.lag_m > 0.0 || way_m < 1e-3) << i;
            late = std::abs(way_m) > 1e-5 ? i : late;
            longest_m = std::max(longest_m, output.lag_m);
            output = step(jumped_m);
        }
        EXPECT_EQ(output.lag_m, 0.0);
        EXPECT_LT(late, 100);
        std::printf("%s: a jump of %.0f mm in a hole: late by %.2f mm, %d frames\n",
                    tool.name.c_str(), 1e3 * kJump_m, 1e3 * longest_m, late);
    }
}

TEST_F(RigidRest, a_cylinder_on_a_cylinder)
{
    const TestModel& peg = test_model("rest-peg", make_shape(Shape::peg, 2'000).value(), 100);
    const Mat3 across = rotation_about(Vec3(0, 1, 0), 1.5707963);
    for (const double off_m : {0.0, 0.004, -0.009})
    {
        for (const double lean : {0.0, 0.4, 1.0})
        {
            const Mat3 turned = rotation_about(Vec3(0, 1, 0), lean) * across;
            press(pin(0.005, 0.02), peg,
                  {{off_m, 0.03, 0.003}, {off_m, 0.012, 0.003}, turned, turned});
        }
    }
    tell("a cylinder");
    EXPECT_LT(errors.force, 5e-3);
    EXPECT_LT(errors.torque, 0.015);
}

TEST_F(RigidRest, a_box_a_hull_and_a_mesh_on_bumps_and_on_teeth)
{
    const TestModel& probe =
        test_model("rest-tool", scaled_mesh(make_uv_sphere(8, 10).value(), 0.2), 60); // 10 mm.
    const TestModel& bumps =
        test_model("rest-bumps", make_shape(Shape::bumpy_sphere, 2'000).value(), 100);
    const TestModel& gear = test_model("rest-gear", make_shape(Shape::gear, 1'500).value(), 100);
    Random random(2'512);
    for (const SolidCore& tool : {box_core("box", Vec3(0.012, 0.008, 0.004), 0.001),
                                  spike_core(0.001), mesh_core("mesh", probe, 0.0015)})
    {
        for (const TestModel* model : {&bumps, &gear})
        {
            for (int i = 0; i < 3; ++i)
            {
                Vec3 way;
                Mat3 turned;
                do // A spike may fit between two teeth.
                {
                    way = random.in_cube(1.0);
                    way.z() *= model == &gear ? 0.1 : 1.0; // The gear is flat.
                    way.normalize();
                    const Vec3 axis = random.in_cube(1.0);
                    turned = rotation_about(axis, random.between(0.0, 3.0));
                } while (crossings(tool, {turned, 0.05 * way - origin_of(*model), 1.0}, *model) ==
                         0);
                press(tool, *model, {0.1 * way, 0.05 * way, turned, turned});
            }
        }
    }
    tell("bumps and teeth");
    EXPECT_LT(errors.force, 2e-3);
    EXPECT_LT(errors.torque, 0.015);
}

} // namespace tactus::test
