// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/change_limit.hpp"
#include "tests/shared/period.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

/// One spring of 500 N/m and 0.05 N m/rad on a device of 8 N and 0.5 N m: slews of 0.08 N and 5 mN
/// m a period.
class LimitedChange
{
public:
    explicit LimitedChange(const ChangeRule& rule = {.arm_m = 0.01})
        : sut(rule, device(), kPeriod_s)
    {
        period.elapsed_s = kPeriod_s;
        period.is_touching = true;
    }

    static DeviceLimits device()
    {
        DeviceLimits limits;
        limits.rotation.torque_max_nm = 0.5;
        limits.rotation.slew_max_nm_per_s = 1e3;
        return limits;
    }

    /// Output force for this input.
    Vec3 step(Vec3 wanted_n, const Vec3& wanted_nm = Vec3(0.0, 0.0, 0.0))
    {
        last = {};
        last.push.force_n = wanted_n;
        last.push.stiffness_n_per_m = 500.0;
        last.torque.force_n = wanted_nm;
        last.torque.stiffness_n_per_m = 0.05;
        last.causes = causes;
        has_acted = sut.hold(last, period);
        sut.follow(last, own_n, Vec3(0.0, 0.0, 0.0));
        return last.push.force_n;
    }
    /// Steps until this force is output, with a resting hand.
    void bring_in(const Vec3& force_n)
    {
        for (int i = 0; i < 1'000 && step(force_n) != force_n; ++i)
        {
        }
        ASSERT_EQ(last.push.force_n, force_n);
        ASSERT_EQ(step(force_n), force_n);
        ASSERT_FALSE(has_acted);
    }

    ChangeLimit sut;
    ToolPeriod period;
    ForceOff causes{ForceOff::none};
    Vec3 own_n{0.0, 0.0, 0.0};
    ToolForce last;
    bool has_acted{false};
};

constexpr double kSlew_n = 0.08;
constexpr double kSlew_nm = 0.005;
constexpr double kTight = 1e-9;

} // namespace

TEST(ChangeLimit, a_touch_that_begins_with_a_long_spring_rises_from_zero)
{
    LimitedChange tool;
    for (int i = 1; i <= 100; ++i)
    {
        ASSERT_NEAR(tool.step(Vec3(8.0, 0.0, 0.0)).x(), std::min(8.0, i * kSlew_n), kTight);
        EXPECT_EQ(tool.has_acted, i < 100) << i;
    }
}

TEST(ChangeLimit, a_hand_that_moves_makes_its_own_change_in_any_direction)
{
    LimitedChange tool;
    tool.bring_in(Vec3(3.0, 0.0, 0.0));
    const Vec3 way(3e-4, -4e-4, 0.0);
    const double step_n = 500.0 * way.norm() + kSlew_n;
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0)})
    {
        const Vec3 before_n = tool.last.push.force_n;
        tool.period.device_m += way;
        EXPECT_LT((tool.step(before_n + 2.0 * direction) - before_n - step_n * direction).norm(),
                  kTight);
        tool.period.device_m += way;
        const Vec3 within_n = tool.last.push.force_n + 0.99 * step_n * direction;
        EXPECT_EQ(tool.step(within_n), within_n);
        EXPECT_FALSE(tool.has_acted);
    }
}

TEST(ChangeLimit, of_hand_and_objects_only_as_much_counts_as_is_believed)
{
    LimitedChange tool({.device_speed_max_m_per_s = 0.4, .object_speed_max_m_per_s = 0.2});
    tool.period.device_m = Vec3(0.5, 0.0, 0.0);
    EXPECT_NEAR(tool.step(Vec3(8, 0, 0)).x(), 500.0 * 0.4e-3 + kSlew_n, kTight);
    tool.period.object_way_m = 0.025;
    EXPECT_NEAR(tool.step(Vec3(8, 0, 0)).x(), 500.0 * 0.6e-3 + 2 * kSlew_n, kTight);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double before_n = tool.last.push.force_n.x();
    tool.period.object_way_m = 0.0;
    tool.period.device_m.y() = nan;
    EXPECT_NEAR(tool.step(Vec3(8, 0, 0)).x(), before_n + kSlew_n, kTight);
    tool.period.device_m.y() = 0.0;
    EXPECT_NEAR(tool.step(Vec3(8, 0, 0)).x(), before_n + 2 * kSlew_n, kTight) << "nor from there";
}

TEST(ChangeLimit, a_hand_that_goes_along_with_an_object_counts_with_it_and_not_twice)
{
    LimitedChange tool;
    const Vec3 way(0.0, 3e-4, 0.0);
    tool.period.object_way_m = 3e-4;
    tool.period.carried_m = way;
    double before_n = 0.0;
    for (const double share : {1.0, 0.0, 0.5, 2.0})
    {
        tool.period.device_m += share * way;
        const double beside_m = std::min(share, std::abs(share - 1.0)) * 3e-4;
        EXPECT_NEAR(tool.step(Vec3(8, 0, 0)).x() - before_n, 500.0 * (beside_m + 3e-4) + kSlew_n,
                    kTight)
            << share;
        before_n = tool.last.push.force_n.x();
    }
}

TEST(ChangeLimit, a_force_doesnt_turn_round_at_once)
{
    LimitedChange tool;
    tool.bring_in(Vec3(4.0, 0.0, 0.0));
    EXPECT_LT((tool.step(Vec3(-4.0, 0.0, 0.0)) - Vec3(4.0 - kSlew_n, 0.0, 0.0)).norm(), kTight);
    tool.period.is_touching = false; // The force crosses zero, which is a permitted decrease.
    EXPECT_LT((tool.step(Vec3(-4.0, 0.0, 0.0)) - Vec3(-kSlew_n, 0.0, 0.0)).norm(), kTight);
}

TEST(ChangeLimit, falls_at_once_where_nothing_is_touched_or_a_cause_fades_it_and_nowhere_else)
{
    LimitedChange tool;
    tool.bring_in(Vec3(4.0, 0.0, 0.0));
    EXPECT_NEAR(tool.step(Vec3(0.0, 0.0, 0.0)).x(), 4.0 - kSlew_n, kTight);
    tool.bring_in(Vec3(4.0, 0.0, 0.0));
    tool.period.is_touching = false;
    EXPECT_EQ(tool.step(Vec3(0.0, 0.0, 0.0)), Vec3(0.0, 0.0, 0.0));
    tool.period.is_touching = true;
    tool.bring_in(Vec3(4.0, 0.0, 0.0));
    tool.causes = ForceOff::stall;
    EXPECT_EQ(tool.step(Vec3(1.0, 0.0, 0.0)), Vec3(1.0, 0.0, 0.0));
    EXPECT_NEAR(tool.step(Vec3(4.0, 0.0, 0.0)).x(), 1.0 + kSlew_n, kTight) << "only falls";
}

TEST(ChangeLimit, a_release_leaves_the_programs_own_force)
{
    LimitedChange tool;
    const Vec3 own_n(0.0, 1.5, 0.0);
    tool.bring_in(Vec3(3.0, 1.5, 0.0));
    tool.own_n = own_n;
    static_cast<void>(tool.step(Vec3(3.0, 1.5, 0.0)));
    tool.period.is_touching = false;
    EXPECT_EQ(tool.step(own_n), own_n);
    EXPECT_NEAR(tool.step(Vec3(0.0, 0.0, 0.0)).y(), 1.5 - kSlew_n, kTight)
        << "in the air it is no release";
}

TEST(ChangeLimit, torques_go_by_the_turn_and_by_the_way_at_the_arm)
{
    LimitedChange tool;
    const Vec3 wanted(0.0, 0.0, 0.5);
    static_cast<void>(tool.step(Vec3(0, 0, 0), wanted));
    EXPECT_NEAR(tool.last.torque.force_n.z(), kSlew_nm, kTight);
    EXPECT_TRUE(has_action(tool.last.torque.actions, ForceAction::change_limited));
    EXPECT_FALSE(has_action(tool.last.push.actions, ForceAction::change_limited));
    tool.period.turned_rad = Vec3(0.02, 0.0, 0.0);
    tool.period.device_m = Vec3(0.0, 2e-4, 0.0);
    tool.period.object_rotation_rad = 0.01; // 0.1 mm at the arm.
    const Vec3 pushed_n = tool.step(Vec3(8, 0, 0), wanted);
    EXPECT_NEAR(tool.last.torque.force_n.z(), 2 * kSlew_nm + 0.05 * 0.02 + 500.0 * 0.01 * 3e-4,
                kTight);
    EXPECT_NEAR(pushed_n.x(), kSlew_n + 500.0 * (2e-4 + 0.01 * 0.02 + 1e-4), kTight);
}

TEST(ChangeLimit, is_told_where_it_acts_for_longer_than_it_may_without)
{
    LimitedChange tool;
    for (int ms = 1; ms <= 40; ++ms)
    {
        static_cast<void>(tool.step(Vec3(8.0, 0.0, 0.0)));
        EXPECT_TRUE(has_action(tool.last.push.actions, ForceAction::change_limited));
        EXPECT_EQ(has_cause(tool.last.causes, ForceOff::growth),
                  ms * kPeriod_s > kChangeTold_s * (1.0 + kTight))
            << ms;
    }
    static_cast<void>(tool.step(tool.last.push.force_n));
    EXPECT_EQ(tool.last.causes, ForceOff::none);
    static_cast<void>(tool.step(Vec3(8.0, 0.0, 0.0)));
    EXPECT_EQ(tool.last.causes, ForceOff::none) << "from the beginning";
}

TEST(ChangeLimit, counts_one_period_of_a_stall_and_no_more_than_the_device_can)
{
    LimitedChange tool;
    tool.period.elapsed_s = 0.5;
    EXPECT_NEAR(tool.step(Vec3(8.0, 0.0, 0.0)).x(), kSlew_n, kTight);
    DeviceLimits slow = LimitedChange::device();
    slow.slew_max_n_per_s = 50.0;
    tool.sut = ChangeLimit({.slew_share_per_ms = 1.0}, slow, kPeriod_s);
    EXPECT_NEAR(tool.step(Vec3(8.0, 0.0, 0.0)).x(), 0.05, kTight);
}

TEST(ChangeLimit, takes_a_slew_within_its_range)
{
    for (const double share : {kSlewShareMin_per_ms, 1.0})
    {
        LimitedChange tool({.slew_share_per_ms = share});
        EXPECT_NEAR(tool.step(Vec3(8.0, 0.0, 0.0)).x(), 8.0 * share, kTight);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double share : {0.0, 0.99 * kSlewShareMin_per_ms, 1.01, nan})
    {
        EXPECT_DEATH(LimitedChange({.slew_share_per_ms = share}), "") << share;
    }
}

} // namespace tactus::test
