// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/operator_rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus
{
namespace
{

OperatorRotationOptions held_loosely()
{
    OperatorRotationOptions options;
    options.device = kDeskRotation;
    options.wrist = {.mass_kg = 5e-5,
                     .stiffness_n_per_m = 0.5,
                     .damping_n_s_per_m = 0.012,
                     .grip_stiffness_n_per_m = 5.0,
                     .grip_damping_n_s_per_m = 0.004};
    return options;
}

/// Rotation by the textbook, with the sine and cosine that the code under test avoids.
Mat3 turned_about(const Vec3& axis, double angle)
{
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

TEST(OperatorRotation, turns_about_one_axis_as_a_point_mass_moves)
{
    auto sut = std::move(OperatorRotation::create(held_loosely())).value();
    OperatorAndDeviceOptions line;
    line.device = {.mass_kg = kDeskRotation.inertia_kg_m2,
                   .damping_n_s_per_m = kDeskRotation.damping_nm_s_per_rad,
                   .force_max_n = kDeskRotation.torque_max_nm,
                   .slew_max_n_per_s = 1.0,
                   .stiffness_max_n_per_m = 1.0};
    line.hand = held_loosely().wrist;
    auto truth = std::move(OperatorAndDevice::create(line)).value();
    const Vec3 axis = Vec3(1.0, -2.0, 2.0) / 3.0;
    double target = 0.0;
    for (int i = 0; i < 3'000; ++i)
    {
        const double torque_nm = i % 700 < 300 ? 0.1 : -0.03;
        target += i < 500 ? 1e-3 : 0.0;
        sut.step(torque_nm * axis, turned_about(axis, target));
        static_cast<void>(truth.step({torque_nm, 0.0, 0.0}, {target, 0.0, 0.0}));
        const Mat3 wanted = turned_about(axis, truth.position_m().x());
        ASSERT_LT((sut.rotation() - wanted).norm(), 1e-7) << i;
        ASSERT_NEAR(sut.velocity_rad_per_s().dot(axis), truth.velocity_m_per_s().x(), 1e-6) << i;
    }
    EXPECT_NEAR(sut.energy().force_work_j, truth.energy().force_work_j, 1e-9);
}

/// Any number of rotations, and beyond pi; the springs know only the poses.
TEST(OperatorRotation, comes_to_rest_where_the_hand_wants_it_after_turns_about_all_axes)
{
    auto sut = std::move(OperatorRotation::create(held_loosely())).value();
    Mat3 target = Mat3::Identity();
    for (int i = 0; i < 6'000; ++i)
    {
        const Vec3 axis(std::sin(0.001 * i), std::cos(0.0017 * i), 0.3);
        target = i < 4'000 ? orthonormalised(turned_about(axis, 2e-3) * target) : target;
        sut.step(i < 3'000 ? Vec3(0.02, -0.05, 0.01) : Vec3(0.0, 0.0, 0.0), target);
    }
    EXPECT_LT((sut.rotation() - target).norm(), 1e-6);
    EXPECT_LT(sut.velocity_rad_per_s().norm(), 1e-6);
}

TEST(OperatorRotation, is_measured_in_steps_of_its_quantum_and_as_a_unit)
{
    OperatorRotationOptions options = held_loosely();
    options.device.quantum_rad = 1e-3;
    auto sut = std::move(OperatorRotation::create(options)).value();
    const Vec3 axis(0.3, 0.5, -0.8);
    for (int i = 0; i < 4'000; ++i)
    {
        sut.step({0.0, 0.0, 0.0}, turned_about(axis, 1e-3 * i));
        const Quaternion measured = sut.measured();
        ASSERT_TRUE(is_unit(measured, 1e-12));
        const Vec3 error =
            rotation_vector(orthonormalised(to_rotation(measured) * sut.rotation().transpose()));
        ASSERT_LE(error.norm(), 1e-3) << i;
    }
}

TEST(OperatorRotation, has_the_rotation_of_its_start_bit_for_bit_until_something_turns_it)
{
    OperatorRotationOptions options = held_loosely();
    options.start = orthonormalised(turned_about({1.0, 1.0, 0.0}, 0.7));
    auto sut = std::move(OperatorRotation::create(options)).value();
    for (int i = 0; i < 10; ++i)
    {
        sut.step({0.0, 0.0, 0.0}, options.start);
    }
    EXPECT_EQ(sut.rotation(), options.start);
    sut.step({0.0, 0.0, 1e-3}, options.start);
    EXPECT_NE(sut.rotation(), options.start);
}

TEST(OperatorRotation, brakes)
{
    auto sut = std::move(OperatorRotation::create(held_loosely())).value();
    const auto angle_after = [&sut](int periods)
    {
        for (int i = 0; i < periods; ++i)
        {
            sut.step({0.0, 0.0, 0.3}, Mat3::Identity());
        }
        return rotation_vector(sut.rotation()).z();
    };
    sut.brake(10.0);
    EXPECT_LT(angle_after(20), 1e-3);
    sut.release_brake();
    EXPECT_GT(angle_after(200), 0.1);
}

TEST(OperatorRotation, refuses_a_device_without_inertia)
{
    OperatorRotationOptions options = held_loosely();
    options.device.inertia_kg_m2 = 0.0;
    const auto sut = OperatorRotation::create(options);
    ASSERT_FALSE(sut);
    EXPECT_EQ(sut.error().text.rfind(
                  "rotation of the simulated operator and device: the device's mass", 0),
              0U)
        << sut.error().text;
}

TEST(Rotations, turn_exactly_for_what_a_period_turns)
{
    for (const double angle : {0.0, 1e-9, 1e-4, 0.01, 0.1})
    {
        const Vec3 axis = Vec3(2.0, -1.0, 2.0) / 3.0;
        const Mat3 from = orthonormalised(turned_about({0.1, 1.0, 0.4}, 2.0));
        const Mat3 sut = turned_exactly_by(angle * axis, from);
        EXPECT_LT((sut - turned_about(axis, angle) * from).norm(), 2e-10) << angle;
    }
}

TEST(Rotations, are_the_same_as_quaternions)
{
    for (int i = 0; i < 100; ++i)
    {
        const Vec3 axis(std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i + 1.0));
        const Mat3 rotation = orthonormalised(turned_about(axis, 0.0628 * i));
        const Quaternion q = to_quaternion(rotation);
        EXPECT_TRUE(is_unit(q, 1e-14));
        EXPECT_LT((to_rotation(q) - rotation).norm(), 1e-14);
    }
}

} // namespace
} // namespace tactus
