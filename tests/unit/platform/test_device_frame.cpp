// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/device_frame.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus
{
namespace
{

Mat3 random_rotation(test::Random& random)
{
    const Vec3 axis = (random.in_cube(1.0) + Vec3(0.0, 0.0, 2.0)).normalized();
    return Eigen::AngleAxisd(random.between(-3.0, 3.0), axis).toRotationMatrix();
}

TEST(DeviceFrame, changes_nothing_by_default)
{
    const DeviceFrame sut;
    EXPECT_EQ(sut.position_to_world(Vec3(1.0, 2.0, 3.0)), Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(sut.velocity_to_world(Vec3(1.0, 2.0, 3.0)), Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(sut.force_to_device(Vec3(1.0, 2.0, 3.0)), Vec3(1.0, 2.0, 3.0));
}

TEST(DeviceFrame, turns_scales_and_moves_as_written_by_hand)
{
    Mat3 quarter; // Rotation about z: x becomes y.
    quarter << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    const DeviceFrame sut = DeviceFrame::create({quarter, Vec3(10.0, 20.0, 30.0), 2.0}).value();
    EXPECT_EQ(sut.position_to_world(Vec3(1.0, 0.0, 3.0)), Vec3(10.0, 22.0, 36.0));
    EXPECT_EQ(sut.velocity_to_world(Vec3(1.0, 0.0, 3.0)), Vec3(0.0, 2.0, 6.0));
    EXPECT_EQ(sut.force_to_device(Vec3(0.0, 5.0, 1.0)), Vec3(5.0, 0.0, 1.0));
}

/// A wall within the stiffness limit of stability.md in the world is within that at the device.
TEST(DeviceFrame, keeps_power_over_the_scale_and_the_stiffness_cap)
{
    test::Random random(41);
    DeviceInfo device;
    device.limits = {.mass_kg = 0.2,
                     .damping_n_s_per_m = 1.7,
                     .friction_n = 0.05,
                     .quantum_m = 1e-5,
                     .delay_s = 2e-4,
                     .force_max_n = 12.0,
                     .stiffness_max_n_per_m = 1e6};
    device.workspace_radius_m = 0.1;
    device.speed_max_m_per_s = 2.0;
    for (int i = 0; i < 1'000; ++i)
    {
        SCOPED_TRACE(i);
        const double scale = random.between(0.01, 100.0);
        const auto made =
            DeviceFrame::create({random_rotation(random), random.in_cube(9.0), scale});
        ASSERT_TRUE(made);
        const DeviceFrame& sut = made.value();
        const Vec3 force_n = random.in_cube(5.0);
        const Vec3 velocity = random.in_cube(1.0);
        const double at_device_w = sut.force_to_device(force_n).dot(velocity);
        const double in_world_w = force_n.dot(sut.velocity_to_world(velocity));
        EXPECT_NEAR(in_world_w, scale * at_device_w, 1e-9 * scale);
        EXPECT_NEAR(sut.force_to_device(force_n).norm(), force_n.norm(), 1e-12);

        const DeviceInfo world = sut.to_world(device);
        EXPECT_EQ(find_fault(world.limits), nullptr);
        const double cap = stiffness_limit(device.limits, 1e-3);
        EXPECT_NEAR(stiffness_limit(world.limits, 1e-3) * scale, cap, 1e-9 * cap);
        EXPECT_NEAR(world.workspace_radius_m, 0.1 * scale, 1e-12 * scale);
        EXPECT_NEAR(world.speed_max_m_per_s, 2.0 * scale, 1e-12 * scale);
        EXPECT_EQ(world.limits.force_max_n, 12.0);
        EXPECT_EQ(world.limits.delay_s, 2e-4);
    }
}

TEST(DeviceFrame, refuses_what_is_no_right_handed_rotation)
{
    const Mat3 one = Mat3::Identity();
    Mat3 mirror = one;
    mirror(2, 2) = -1.0;
    Mat3 slanted = one;
    slanted(0, 1) = 1e-5;
    Mat3 unknown = one;
    unknown(1, 1) = std::numeric_limits<double>::quiet_NaN();
    for (const Mat3& bad : {mirror, slanted, unknown, Mat3(2.0 * one), Mat3(Mat3::Zero())})
    {
        const auto refused = DeviceFrame::create({bad, Vec3::Zero(), 1.0});
        ASSERT_FALSE(refused);
    }
    Mat3 rounded = one;
    rounded(0, 1) = 1e-7;
    const auto mended = DeviceFrame::create({rounded, Vec3::Zero(), 1.0});
    ASSERT_TRUE(mended);
    EXPECT_NEAR(mended.value().force_to_device(Vec3(3.0, 4.0, 0.0)).norm(), 5.0, 1e-15);
}

TEST(DeviceFrame, refuses_places_and_scales_out_of_range)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, 0.999 * kPoseScaleMin, 1.001 * kPoseScaleMax, nan})
    {
        EXPECT_FALSE(DeviceFrame::create({Mat3::Identity(), Vec3::Zero(), bad})) << bad;
    }
    for (const double bad : {1.001 * kPoseReachMax_m, -1.001 * kPoseReachMax_m, nan})
    {
        EXPECT_FALSE(DeviceFrame::create({Mat3::Identity(), Vec3(0.0, bad, 0.0), 1.0})) << bad;
    }
    const Vec3 farthest_m(kPoseReachMax_m, -kPoseReachMax_m, 0.0);
    EXPECT_TRUE(DeviceFrame::create({Mat3::Identity(), farthest_m, kPoseScaleMin}));
    EXPECT_TRUE(DeviceFrame::create({Mat3::Identity(), Vec3::Zero(), kPoseScaleMax}));
}

} // namespace
} // namespace tactus
