// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/gravity_compensation.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

constexpr double kCarryRounding = 1e-12;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr WrenchLimits kCarrier{8.0, 0.5};

/// 1.96 N, and 0.098 N m if its centre is level.
ToolLoad hammer_load()
{
    return {0.2, Vec3(0.05, 0.0, 0.0), Vec3(0.0, 0.0, -1.0)};
}

struct CarryInput
{
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0};
    ForceOff causes{ForceOff::none};
    Mat3 rotation{Mat3::Identity()};
    double force_left{1.0};
};

ToolForce carry(GravityCompensation& sut, const CarryInput& input)
{
    ToolForce force;
    force.push.force_n = input.force_n;
    force.torque.force_n = input.torque_nm;
    force.state = SafetyState::force;
    force.causes = input.causes;
    ToolPeriod period;
    period.device_rotation = input.rotation;
    period.force_left = input.force_left;
    period.elapsed_s = kPeriod_s;
    sut.carry(force, period);
    return force;
}

GravityCompensation carrying(const ToolLoad& load, const WrenchLimits& limits = kCarrier)
{
    GravityCompensation sut(load, limits);
    for (int i = 0; i < 200; ++i)
    {
        static_cast<void>(carry(sut, {}));
    }
    return sut;
}

Mat3 turned_tool(const Vec3& rotation_rad)
{
    return turned_by(rotation_rad, Mat3::Identity());
}

} // namespace

TEST(GravityCompensation, carries_weight_and_lever_however_the_tool_is_turned)
{
    const ToolLoad load = hammer_load();
    for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(0.3, 0, 0), Vec3(0, 0.7, 0), Vec3(0.2, -0.5, 1)})
    {
        GravityCompensation sut(load, kCarrier);
        CarryInput input;
        input.rotation = turned_tool(turn);
        ToolForce sent;
        for (int i = 0; i < 200; ++i)
        {
            sent = carry(sut, input);
        }
        const Vec3 up(0.0, 0.0, 0.2 * 9.80665);
        EXPECT_LT((sent.load_n - up).norm(), kCarryRounding);
        EXPECT_LT((sent.load_nm - (input.rotation * load.centre_m).cross(up)).norm(),
                  kCarryRounding);
    }
}

TEST(GravityCompensation, without_a_load_changes_no_bit)
{
    GravityCompensation sut({}, kCarrier);
    CarryInput input;
    input.force_n = Vec3(7.9, 0.1, 0.2);
    input.torque_nm = Vec3(0.1, 0.2, 0.3);
    const ToolForce sent = carry(sut, input);
    EXPECT_EQ(sent.push.force_n, input.force_n);
    EXPECT_EQ(sent.torque.force_n, input.torque_nm);
    EXPECT_EQ(sent.load_n, Vec3(0.0, 0.0, 0.0));
}

TEST(GravityCompensation, holds_while_the_scene_is_at_fault_and_lets_go_with_the_device)
{
    for (std::size_t bit = 0; bit < kForceOffs; ++bit)
    {
        const auto cause = static_cast<ForceOff>(1U << bit);
        const bool is_scene = cause == ForceOff::server || cause == ForceOff::stall ||
                              cause == ForceOff::jump || cause == ForceOff::halted ||
                              cause == ForceOff::over_constrained || cause == ForceOff::clutch ||
                              cause == ForceOff::starved || cause == ForceOff::growth;
        GravityCompensation sut = carrying(hammer_load());
        CarryInput input;
        input.causes = cause;
        double last_n = hammer_load().weight_n();
        for (int i = 0; i < 60; ++i)
        {
            const double now_n = carry(sut, input).load_n.norm();
            EXPECT_LE(last_n - now_n,
                      hammer_load().weight_n() * kPeriod_s / kFadeTime_s + kCarryRounding);
            last_n = now_n;
        }
        EXPECT_NEAR(last_n, is_scene ? hammer_load().weight_n() : 0.0, kCarryRounding)
            << kForceOffNames[bit];
    }
    GravityCompensation sut = carrying(hammer_load());
    CarryInput lost;
    lost.force_left = 0.0;
    EXPECT_EQ(carry(sut, lost).load_n.norm(), 0.0);
    EXPECT_NEAR(carry(sut, {}).load_n.norm(), hammer_load().weight_n() * kPeriod_s / kRiseTime_s,
                kCarryRounding);
}

TEST(GravityCompensation, garbage_neither_pushes_nor_turns)
{
    GravityCompensation sut = carrying(hammer_load());
    const ToolForce before = carry(sut, {});
    CarryInput input;
    input.causes = ForceOff::garbage;
    double gain = 1.0;
    for (const double bad : {kNoNumber, 1e300, -1.0})
    {
        input.rotation = Mat3::Constant(bad);
        const ToolForce sent = carry(sut, input);
        EXPECT_LT(sut.gain(), gain);
        gain = sut.gain();
        EXPECT_LT((sent.load_n - gain * before.load_n).norm(), kCarryRounding);
        EXPECT_LT((sent.load_nm - gain * before.load_nm).norm(), kCarryRounding);
    }
}

/// The wrong sample is not detected as such.
TEST(GravityCompensation, a_rotation_that_jumps_turns_the_torque_no_faster_than_a_hand)
{
    GravityCompensation sut = carrying(hammer_load());
    Vec3 last_nm = carry(sut, {}).load_nm;
    CarryInput input;
    input.rotation = turned_tool(Vec3(0.0, 3.0, 0.0));
    for (int i = 0; i < 60; ++i)
    {
        const ToolForce sent = carry(sut, input);
        EXPECT_LE((sent.load_nm - last_nm).norm(),
                  hammer_load().torque_max_nm() * kRotationMax_rad_per_s * kPeriod_s +
                      kCarryRounding);
        EXPECT_LE(sent.load_nm.norm(), hammer_load().torque_max_nm() + kCarryRounding);
        last_nm = sent.load_nm;
    }
    EXPECT_LT((last_nm - (input.rotation * hammer_load().centre_m).cross(carry(sut, input).load_n))
                  .norm(),
              kCarryRounding);
}

TEST(GravityCompensation, both_together_stay_within_the_device_by_one_gain)
{
    Random random = Random::seeded(seed_of(25));
    GravityCompensation sut = carrying(hammer_load());
    int shortened = 0;
    for (int i = 0; i < 2'000; ++i)
    {
        SCOPED_TRACE(i);
        CarryInput input;
        const Vec3 force = random.in_cube(1.0);
        const Vec3 torque = random.in_cube(1.0);
        input.force_n = force * (random.between(0.0, 8.0) / std::max(force.norm(), 1.0));
        input.torque_nm = torque * (random.between(0.0, 0.5) / std::max(torque.norm(), 1.0));
        const ToolForce sent = carry(sut, input);
        EXPECT_NEAR(sent.load_n.norm(), hammer_load().weight_n(), kCarryRounding)
            << "the load goes out whole";
        const double force_n = (sent.push.force_n + sent.load_n).norm();
        const double torque_nm = (sent.torque.force_n + sent.load_nm).norm();
        EXPECT_LE(force_n, kCarrier.force_max_n + kCarryRounding);
        EXPECT_LE(torque_nm, kCarrier.torque_max_nm + kCarryRounding);
        const double gain = sent.push.force_n.norm() / input.force_n.norm();
        EXPECT_LT((sent.push.force_n - gain * input.force_n).norm(), kCarryRounding);
        EXPECT_LT((sent.torque.force_n - gain * input.torque_nm).norm(), kCarryRounding);
        EXPECT_LE(gain, 1.0 + kCarryRounding);
        if (gain < 1.0 - 1e-9)
        {
            ++shortened;
            EXPECT_TRUE(force_n > kCarrier.force_max_n - 1e-9 ||
                        torque_nm > kCarrier.torque_max_nm - 1e-9)
                << "no more than it must";
        }
    }
    EXPECT_GT(shortened, 100);
}

TEST(GravityCompensation, a_device_without_torque_carries_the_weight_alone)
{
    GravityCompensation sut = carrying(hammer_load(), {8.0, 0.0});
    const ToolForce sent = carry(sut, {});
    EXPECT_NEAR(sent.load_n.z(), hammer_load().weight_n(), kCarryRounding);
    EXPECT_EQ(sent.load_nm, Vec3(0.0, 0.0, 0.0));
}

} // namespace tactus::test
