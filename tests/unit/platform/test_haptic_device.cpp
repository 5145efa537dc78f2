// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/haptic_device.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/system_call_trap.hpp"
#include "rt_core/math/rotation.hpp"
#include "tests/unit/platform/dhd_rig.hpp"
#include "tests/unit/platform/udp_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>

namespace tactus
{
namespace
{

using test::DeviceRig;

std::unique_ptr<DeviceRig> make_simulated()
{
    return std::make_unique<test::SimulatedRig>();
}

template <const DeviceLimits& limits>
std::unique_ptr<DeviceRig> make_class()
{
    return std::make_unique<test::SimulatedRig>(limits);
}

std::unique_ptr<DeviceRig> make_replay()
{
    return std::make_unique<test::ReplayRig>();
}

std::unique_ptr<DeviceRig> make_udp()
{
    return std::make_unique<test::UdpRig>();
}

/// Rotated by a quarter turn about z, moved, and ten times as large.
std::unique_ptr<DeviceRig> make_udp_elsewhere()
{
    Mat3 quarter;
    quarter << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    return std::make_unique<test::UdpRig>(
        DeviceFrame::create({quarter, Vec3(1.0, 2.0, 3.0), 10.0}).value());
}

std::unique_ptr<DeviceRig> make_dhd()
{
    return std::make_unique<test::DhdRig>();
}

/// Promises of every device, with a hand that holds it loosely at one place.
struct HapticDeviceConformance : testing::TestWithParam<std::unique_ptr<DeviceRig> (*)()>
{
    /// Displacement from the first reading after `frames` under a steady force.
    double drift_m(const std::array<double, 3>& force_n, int frames)
    {
        const auto start = rig->next().position_world_m;
        DeviceSample sample;
        for (int i = 0; i < frames; ++i)
        {
            rig->device().write({force_n, {}, 0.0});
            sample = rig->next();
        }
        const auto end = sample.position_world_m;
        return std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
    }

    std::unique_ptr<DeviceRig> rig = GetParam()();
};

INSTANTIATE_TEST_SUITE_P(Simulated, HapticDeviceConformance,
                         testing::Values(&make_simulated, &make_class<kTouchClass>,
                                         &make_class<kOmegaClass>, &make_class<kDeltaClass>));
INSTANTIATE_TEST_SUITE_P(Replay, HapticDeviceConformance, testing::Values(&make_replay));
INSTANTIATE_TEST_SUITE_P(Udp, HapticDeviceConformance,
                         testing::Values(&make_udp, &make_udp_elsewhere));
INSTANTIATE_TEST_SUITE_P(Dhd, HapticDeviceConformance, testing::Values(&make_dhd));

TEST_P(HapticDeviceConformance, describes_itself_with_sane_limits)
{
    const DeviceInfo& info = rig->device().info();
    EXPECT_FALSE(info.name.empty());
    EXPECT_GT(info.limits.force_max_n, 0.0);
    EXPECT_GT(info.limits.stiffness_max_n_per_m, 0.0);
    EXPECT_GE(info.limits.damping_n_s_per_m, 0.0);
    EXPECT_GT(info.workspace_radius_m, 0.0);
    EXPECT_GT(info.speed_max_m_per_s, 0.0);
    EXPECT_GT(info.rate_min_hz, 0);
    EXPECT_GE(info.rate_max_hz, info.rate_min_hz);
}

TEST_P(HapticDeviceConformance, counts_its_readings_and_never_goes_back_in_time)
{
    MonotonicTime last = rig->next().time;
    for (std::uint64_t frame = 1; frame < 100; ++frame)
    {
        const DeviceSample sample = rig->next();
        EXPECT_TRUE(sample.valid);
        EXPECT_TRUE(sample.connected);
        EXPECT_TRUE(sample.deadman_held);
        EXPECT_EQ(sample.frame, frame);
        EXPECT_GE(sample.time, last); // A late I/O thread leaves the last reading.
        last = sample.time;
    }
    EXPECT_EQ(rig->device().status().frames, 100U);
}

TEST_P(HapticDeviceConformance, is_idle_until_the_first_force)
{
    static_cast<void>(rig->next());
    EXPECT_EQ(rig->device().status().state, DeviceState::idle);
    rig->device().write({{0.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(rig->device().status().state, DeviceState::force);
}

TEST_P(HapticDeviceConformance, gives_way_to_the_force_it_is_told_to_make_or_not_at_all)
{
    const double way_m = drift_m({0.0, 1.0, 0.0}, 300);
    EXPECT_TRUE(rig->gives_way() ? way_m > 1e-3 : way_m == 0.0) << way_m;
}

/// A device without torque takes the force alone; one without rotation reports none.
TEST_P(HapticDeviceConformance, turns_by_the_torque_it_is_told_to_make_or_not_at_all)
{
    const RotationLimits& turn = rig->device().info().limits.rotation;
    const DeviceSample start = rig->next();
    EXPECT_EQ(start.rotation_world.has_value(), turn.is_measured);
    DeviceSample sample;
    for (int i = 0; i < 300; ++i)
    {
        rig->device().write({{}, {0.02, 0.05, -0.01}, 0.0});
        sample = rig->next();
    }
    ASSERT_EQ(sample.rotation_world.has_value(), turn.is_measured);
    if (!turn.is_measured)
    {
        return;
    }
    const Mat3 way =
        to_rotation(*sample.rotation_world) * to_rotation(*start.rotation_world).transpose();
    const Vec3 turned = rotation_vector(orthonormalised(way));
    const bool is_turned = turn.torque_max_nm > 0.0 && rig->turns();
    EXPECT_TRUE(is_turned ? turned.normalized().dot(Vec3(0.02, 0.05, -0.01).normalized()) > 0.99
                          : turned.norm() == 0.0)
        << turned.transpose();
}

TEST_P(HapticDeviceConformance, shortens_force_and_torque_by_one_factor)
{
    const DeviceLimits& limits = rig->device().info().limits;
    static_cast<void>(rig->next());
    rig->device().write({{0.1 * limits.force_max_n, 0.0, 0.0}, {0.0, 1e3, 0.0}, 0.0});
    const bool has_torque = limits.rotation.torque_max_nm > 0.0;
    EXPECT_EQ(rig->device().status().forces_clamped, has_torque ? 1U : 0U);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        rig->device().write({{}, {0.0, bad, 0.0}, 0.0});
        rig->device().write({{}, {}, bad});
    }
    EXPECT_EQ(rig->device().status().forces_refused, has_torque ? 4U : 2U);
}

TEST_P(HapticDeviceConformance, clamps_a_force_beyond_its_limit_and_counts_it)
{
    const double limit_n = rig->device().info().limits.force_max_n;
    auto other = GetParam()();
    const double at_limit_m = drift_m({limit_n, 0.0, 0.0}, 300);
    rig.swap(other);
    const double beyond_m = drift_m({1e6, 0.0, 0.0}, 300);
    EXPECT_NEAR(beyond_m, at_limit_m, 1e-9);
    EXPECT_EQ(rig->device().status().forces_clamped, 300U);
}

TEST_P(HapticDeviceConformance, refuses_a_force_that_is_not_finite_and_makes_none)
{
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        EXPECT_EQ(drift_m({0.0, bad, 1.0}, 50), 0.0);
    }
    EXPECT_EQ(rig->device().status().forces_refused, 100U);
}

TEST_P(HapticDeviceConformance, ignores_forces_from_the_brake_to_its_release)
{
    rig->device().write({{5.0, 0.0, 0.0}, {}, 0.0});
    std::thread other([&] { rig->device().brake(); });
    other.join();
    EXPECT_EQ(rig->device().status().state, DeviceState::brake);
    EXPECT_EQ(drift_m({5.0, 0.0, 0.0}, 100), 0.0);
    rig->device().brake(); // The second call has no effect.
    EXPECT_EQ(drift_m({5.0, 0.0, 0.0}, 10), 0.0);
    rig->device().release_brake();
    EXPECT_EQ(rig->device().status().state, DeviceState::idle);
    const auto start = rig->next().position_world_m;
    EXPECT_EQ(rig->next().position_world_m, start); // Not the force from before.
    EXPECT_EQ(drift_m({5.0, 0.0, 0.0}, 100) > 0.0, rig->gives_way());
    EXPECT_EQ(rig->device().status().state, DeviceState::force);
}

TEST_P(HapticDeviceConformance, brakes_softly_at_once_or_by_a_fade)
{
    rig->device().write({{5.0, 0.0, 0.0}, {}, 0.0});
    rig->device().brake_softly();
    const DeviceStatus braked = rig->device().status();
    EXPECT_EQ(braked.state, DeviceState::brake);
    EXPECT_GE(braked.force_left, 0.0);
    EXPECT_LE(braked.force_left, 1.0);
    rig->device().brake();
    EXPECT_EQ(rig->device().status().force_left, 0.0);
    EXPECT_EQ(drift_m({5.0, 0.0, 0.0}, 100), 0.0);
    rig->device().release_brake();
    EXPECT_EQ(rig->device().status().state, DeviceState::idle);
}

TEST_P(HapticDeviceConformance, leaves_the_heap_alone)
{
    if (!allocation_counter::available())
    {
        GTEST_SKIP() << "allocation counter: not available under a sanitizer or without glibc";
    }
    const auto before = allocation_counter::of_this_thread();
    allocation_counter::mark_this_thread(true);
    for (int i = 0; i < 100; ++i)
    {
        static_cast<void>(rig->device().read());
        rig->device().write({{0.1, 0.2, 0.3}, {}, 0.0});
    }
    rig->device().brake();
    rig->device().release_brake();
    allocation_counter::mark_this_thread(false);
    const auto after = allocation_counter::of_this_thread();
    EXPECT_EQ(after.allocations, before.allocations);
    EXPECT_EQ(after.frees, before.frees);
}

/// Runs on a separate thread, since a trap is permanent. brake() is exempt: it is for when
/// everything else has failed.
TEST_P(HapticDeviceConformance, makes_no_system_call)
{
    static_cast<void>(rig->next());
    std::string refused;
    system_call_trap::TrappedCalls calls;
    std::thread haptic(
        [&]
        {
            if (const auto set = system_call_trap::set_on_this_thread(); !set)
            {
                refused = set.error().text;
                return;
            }
            // A sanitizer looks up an object's type by system calls, once.
            static_cast<void>(rig->device().read());
            system_call_trap::mark_frame(true);
            for (int i = 0; i < 100; ++i)
            {
                static_cast<void>(rig->device().read());
                rig->device().write({{0.1, 0.2, 0.3}, {}, 0.0});
                static_cast<void>(rig->device().status());
            }
            rig->device().release_brake();
            system_call_trap::mark_frame(false);
            calls = system_call_trap::of_this_thread();
        });
    haptic.join();
    if (!refused.empty())
    {
        GTEST_SKIP() << refused;
    }
    EXPECT_EQ(calls.in_frame, 0U) << "the first was number " << calls.first_in_frame;
}

} // namespace
} // namespace tactus
