// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/operator_and_device.hpp"
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

} // namespace tactus::test
