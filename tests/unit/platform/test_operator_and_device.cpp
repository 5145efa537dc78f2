// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/operator_and_device.hpp"
#include "platform/devices/simulated/operator_rotation.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::test
{
namespace
{

/// Mass of 0.2 kg in empty space, released by the hand.
OperatorAndDeviceOptions free_mass()
{
    OperatorAndDeviceOptions options;
    options.device.mass_kg = 0.2;
    options.device.damping_n_s_per_m = 0.0;
    options.device.force_max_n = 10.0;
    options.hand.grip_stiffness_n_per_m = 0.0;
    options.hand.grip_damping_n_s_per_m = 0.0;
    return options;
}

OperatorAndDevice make(const OperatorAndDeviceOptions& options)
{
    return OperatorAndDevice::create(options).value();
}

std::string refusal(const OperatorAndDeviceOptions& options)
{
    const auto made = OperatorAndDevice::create(options);
    return made ? std::string() : made.error().text;
}

const Vec3 kHome(0, 0, 0);

/// Steps under one force, with the hand's target at home.
void steps(OperatorAndDevice& sut, const Vec3& force_n, int count)
{
    for (int i = 0; i < count; ++i)
    {
        sut.step(force_n, kHome);
    }
}

} // namespace

TEST(OperatorAndDevice, swings_as_two_masses_on_a_spring_do)
{
    OperatorAndDeviceOptions options = free_mass();
    options.period_s = 2.5e-4;
    options.hand = {0.1, 0.0, 0.0, 1'000.0, 0.0};
    OperatorAndDevice sut = make(options);
    const double w = std::sqrt(1'000.0 * (1.0 / 0.2 + 1.0 / 0.1));
    for (int i = 1; i <= 2'000; ++i)
    {
        sut.step(Vec3(0.3, 0, 0), kHome);
        const double t = options.period_s * i;
        const double apart = 0.3 / 0.2 / (w * w) * (1.0 - std::cos(w * t));
        const double middle = 0.5 * 0.3 / 0.3 * t * t;
        EXPECT_NEAR(sut.position_m().x(), middle + apart / 3.0, 2e-8);
        EXPECT_NEAR(sut.hand_m().x(), middle - apart * 2.0 / 3.0, 2e-8);
    }
}

TEST(OperatorAndDevice, its_brake_adds_damping_until_it_is_released)
{
    OperatorAndDeviceOptions options = free_mass();
    options.device.damping_n_s_per_m = 1.0;
    OperatorAndDevice sut = make(options);
    steps(sut, Vec3(2.0, 0, 0), 100);
    const double before = sut.velocity_m_per_s().x();
    sut.brake(9.0);
    for (int i = 1; i <= 50; ++i)
    {
        sut.step(kHome, kHome);
        EXPECT_NEAR(sut.velocity_m_per_s().x(), before * std::exp(-50e-3 * i), 1e-6);
    }
    const double slowed = sut.velocity_m_per_s().x();
    sut.release_brake();
    for (int i = 1; i <= 50; ++i)
    {
        sut.step(kHome, kHome);
        EXPECT_NEAR(sut.velocity_m_per_s().x(), slowed * std::exp(-5e-3 * i), 1e-6);
    }
}

TEST(OperatorAndDevice, is_held_still_by_friction_and_no_longer)
{
    OperatorAndDeviceOptions options = free_mass();
    options.device.friction_n = 1.0;
    OperatorAndDevice sut = make(options);
    steps(sut, Vec3(0.6, 0.0, 0.79), 100); // 0.992 N.
    EXPECT_EQ(sut.position_m(), kHome);
    steps(sut, Vec3(3.0, 0, 0), 100);
    EXPECT_NEAR(sut.velocity_m_per_s().x(), 1.0, 1e-12); // (3 - 1) N / 0.2 kg x 0.1 s.
    const double from = sut.position_m().x();
    steps(sut, Vec3(0, 0, 0), 300);
    EXPECT_EQ(sut.velocity_m_per_s(), kHome);
    EXPECT_NEAR(sut.position_m().x() - from, 0.1, 1e-5); // m v^2 / 2 / friction.
    EXPECT_NEAR(sut.energy().friction_loss_j, sut.position_m().x(), 1e-12);
}

TEST(OperatorAndDevice, feels_a_force_as_late_as_its_delay_says)
{
    for (const double delay_periods : {0.0, 0.35, 1.0, 1.5, 8.0})
    {
        OperatorAndDeviceOptions options = free_mass();
        options.device.delay_s = delay_periods * options.period_s;
        OperatorAndDevice sut = make(options);
        for (int i = 1; i <= 20; ++i)
        {
            sut.step(Vec3(2.0, 0, 0), kHome);
            const double t = 1e-3 * std::max(0.0, i - delay_periods);
            EXPECT_NEAR(sut.position_m().x(), 5.0 * t * t, 1e-14) << delay_periods << " " << i;
        }
    }
}

TEST(OperatorAndDevice, is_measured_in_whole_quanta_to_the_nearest)
{
    OperatorAndDeviceOptions options = free_mass();
    options.device.quantum_m = 1e-4;
    OperatorAndDevice sut = make(options);
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 measured = sut.step(Vec3(0.2, -0.1, 0), kHome);
        EXPECT_EQ(measured, sut.measured_m());
        EXPECT_LE((measured - sut.position_m()).cwiseAbs().maxCoeff(), 0.5e-4 * (1 + 1e-9));
        EXPECT_NEAR(std::remainder(measured.x(), 1e-4), 0.0, 1e-12);
    }
}

TEST(OperatorAndDevice, cuts_forces_to_its_motors_and_takes_no_number_for_none)
{
    OperatorAndDevice sut = make(free_mass());
    sut.step(Vec3(300.0, -400.0, 0), kHome);
    EXPECT_NEAR(sut.velocity_m_per_s().x(), 6.0 / 0.2 * 1e-3, 1e-12);
    EXPECT_NEAR(sut.velocity_m_per_s().y(), -8.0 / 0.2 * 1e-3, 1e-12);
    const Vec3 before = sut.velocity_m_per_s();
    sut.step(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), kHome);
    sut.step(Vec3(0, std::numeric_limits<double>::infinity(), 0), kHome);
    EXPECT_LT((sut.velocity_m_per_s() - before).norm(), 1e-12);
}

TEST(OperatorAndDevice, loses_no_energy_but_what_it_says)
{
    Random random(6);
    for (int trial = 0; trial < 20; ++trial)
    {
        OperatorAndDeviceOptions options;
        options.device = kOmegaClass;
        options.device.friction_n = 0.0;
        options.device.delay_s = trial % 2 == 0 ? 0.0 : 1.4e-3;
        options.workspace_radius_m = trial % 4 == 3 ? 0.01 : 1.0;
        OperatorAndDevice sut = make(options);
        Vec3 target = kHome;
        double scale = 0.0;
        for (int i = 0; i < 1'000; ++i)
        {
            target += random.in_cube(1e-3);
            sut.step(random.in_cube(8.0), target);
            const OperatorAndDeviceEnergy& energy = sut.energy();
            const double left = energy.force_work_j + energy.target_work_j - energy.viscous_loss_j -
                                energy.hand_loss_j - energy.stop_loss_j;
            scale = std::max(scale, energy.viscous_loss_j + energy.hand_loss_j);
            ASSERT_NEAR(left, sut.stored_j(), 1e-12 + 1e-11 * scale) << "trial " << trial;
        }
        EXPECT_EQ(sut.energy().stop_loss_j > 0.0, options.workspace_radius_m < 0.1);
    }
}

TEST(OperatorAndDevice, brings_the_device_to_the_target_and_stays_within_reach)
{
    OperatorAndDeviceOptions options;
    options.device = kTouchClass;
    options.device.friction_n = 0.0;
    options.workspace_radius_m = 0.05;
    OperatorAndDevice sut = make(options);
    for (int i = 0; i < 3'000; ++i)
    {
        sut.step(kHome, Vec3(0.02, 0.01, 0));
    }
    EXPECT_LT((sut.position_m() - Vec3(0.02, 0.01, 0)).norm(), 1e-6);
    for (int i = 0; i < 3'000; ++i)
    {
        sut.step(kHome, Vec3(0.2, 0, 0));
        EXPECT_LE(sut.position_m().norm(), 0.05 * (1 + 1e-12));
    }
    EXPECT_NEAR(sut.position_m().norm(), 0.05, 1e-12);
}

TEST(OperatorAndDevice, refuses_what_it_cannot_be)
{
    EXPECT_EQ(refusal({}), "");
    OperatorAndDeviceOptions options;
    options.device.mass_kg = 0.0;
    EXPECT_NE(refusal(options).find("device's mass"), std::string::npos);
    options = {};
    options.hand = {0.0, 0.0, 0.0, 100.0, 1.0};
    EXPECT_NE(refusal(options).find("operator's values"), std::string::npos);
    options = {};
    options.period_s = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal(options).find("period"), std::string::npos);
    options = {};
    options.device.delay_s = 8.1e-3;
    EXPECT_NE(refusal(options).find("delay"), std::string::npos);
    options = {};
    options.start_world_m = Vec3(2, 0, 0);
    EXPECT_NE(refusal(options).find("workspace"), std::string::npos);
}

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
} // namespace tactus::test
