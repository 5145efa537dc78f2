// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/external_force.hpp"
#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/force_limiter.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "tests/shared/commanded_force.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::test
{

namespace
{

constexpr double kRounding = 1e-12;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Device of at most 10 N.
ConditionerSetup plain_setup()
{
    ConditionerSetup setup;
    setup.device.force_max_n = 10.0;
    setup.device.damping_n_s_per_m = 2.0;
    setup.device.stiffness_max_n_per_m = 5'000.0;
    setup.period_s = kPeriod_s;
    return setup;
}

/// Force of a wall and of a program together, for one tool.
ToolForce with_own(const CommandedForce& commanded, const ExternalForce& own)
{
    ToolForce both;
    both.push = commanded.spring();
    both.torque = commanded.spring();
    add_external(both, own);
    return both;
}

CommandedForce force(double x)
{
    CommandedForce commanded;
    commanded.force_n = Vec3(x, 0, 0);
    return commanded;
}

} // namespace

TEST(ExternalForce, is_a_spring_to_a_point_of_limited_force)
{
    const ExternalForce near = spring_to(Vec3(0.01, 0, 0), Vec3(0, 0.01, 0), 200.0, 5.0);
    EXPECT_LT((near.force_n - Vec3(2, -2, 0)).norm(), kRounding);
    EXPECT_EQ(near.stiffness_n_per_m, 200.0);
    const ExternalForce far = spring_to(Vec3(10, 0, 0), Vec3(0, 0, 0), 200.0, 5.0);
    EXPECT_LT((far.force_n - Vec3(5, 0, 0)).norm(), kRounding);
}

TEST(ExternalForce, two_springs_hold_together_what_each_holds)
{
    constexpr double kWall = 500.0;
    constexpr double kOwn = 300.0;
    for (const double own_n : {2.0, -1.0, 0.5})
    {
        for (const double over_m : {0.0, 0.004}) // The wall's force may be clamped.
        {
            CommandedForce commanded = force(3.0);
            commanded.stiffness_n_per_m = kWall;
            commanded.stretch_m = 3.0 / kWall + over_m;
            const Vec3 own(0.3 * own_n, own_n, 0.0);
            const CommandedForce both = with_spring(commanded, own, kOwn);
            EXPECT_EQ(both.force_n, Vec3(commanded.force_n + own));
            EXPECT_EQ(both.stiffness_n_per_m, kWall + kOwn);
            const double wall_j = 0.5 * 3.0 * 3.0 / kWall + 3.0 * over_m;
            const double own_j = 0.5 * own.squaredNorm() / kOwn;
            const double sum_n = both.force_n.norm();
            const double least_m = sum_n / both.stiffness_n_per_m;
            EXPECT_GE(both.stretch_m, least_m * (1.0 - kRounding));
            EXPECT_NEAR(sum_n * (both.stretch_m - 0.5 * least_m), wall_j + own_j, kRounding);
        }
    }
}

TEST(ExternalForce, without_one_the_request_is_as_it_was_and_in_the_air_its_spring_is_alone)
{
    CommandedForce commanded = force(0.0);
    commanded.stiffness_n_per_m = 500.0;
    commanded.stretch_m = 0.25;
    const SpringForce same = with_own(commanded, {}).push;
    EXPECT_EQ(same.stiffness_n_per_m, 500.0);
    EXPECT_EQ(same.stretch_m, 0.25);
    EXPECT_EQ(same.force_n, commanded.force_n);
    ExternalForce own;
    own.torque_nm = Vec3(0, 0.2, 0);
    own.stiffness_nm_per_rad = 2.0;
    const SpringForce torque = with_own(commanded, own).torque;
    EXPECT_EQ(torque.stiffness_n_per_m, 2.0);
    EXPECT_NEAR(torque.stretch_m, 0.1, kRounding);
}

/// A hand moves across a spring of the program's own. A delayed one generates energy.
TEST(ExternalForce, that_is_a_spring_is_not_damped_and_one_that_makes_energy_is)
{
    for (const int late : {0, 40})
    {
        ForceConditioner sut(plain_setup());
        const auto place = [](int frame) { return Vec3(0.02 * std::sin(0.005 * frame), 0, 0); };
        std::uint32_t damped = 0;
        for (int i = 0; i < 4'000; ++i)
        {
            const ExternalForce own = spring_to(Vec3(0, 0, 0), place(i - late), 300.0, 8.0);
            CommandedForce commanded;
            commanded.position_m = place(i);
            const ForceAction actions =
                condition(sut, with_spring(commanded, own.force_n, own.stiffness_n_per_m)).actions;
            damped += has_action(actions, ForceAction::damped) ? 1U : 0U;
        }
        EXPECT_EQ(damped > 0, late > 0) << damped;
    }
}

TEST(ForceLimiter, clamps_the_norm_and_keeps_the_direction)
{
    EXPECT_EQ(clamp_norm(Vec3(3, 4, 0), 5.0), Vec3(3, 4, 0));
    EXPECT_LT((clamp_norm(Vec3(6, 8, 0), 5.0) - Vec3(3, 4, 0)).norm(), kRounding);
    EXPECT_NEAR(clamp_norm(Vec3(1e300, -1e300, 1e300), 5.0).norm(), 5.0, kRounding);
    for (const double bad : {kNan, kInfinite, -kInfinite})
    {
        EXPECT_EQ(clamp_norm(Vec3(1, bad, 1), 5.0), Vec3(0, 0, 0));
    }
}

TEST(ForceLimiter, changes_by_a_step_at_most_straight_to_the_request_and_reaches_it)
{
    Random random(2);
    for (int trial = 0; trial < 2'000; ++trial)
    {
        Vec3 now = random.in_cube(5.0);
        const Vec3 commanded = random.in_cube(5.0);
        const double longest = std::max(now.norm(), commanded.norm());
        const double step = random.between(0.01, 2.0);
        for (int i = 0; i < 2'000 && now != commanded; ++i)
        {
            const Vec3 next = limit_change(now, commanded, step);
            ASSERT_LE((next - now).norm(), step * (1.0 + kRounding)) << "trial " << trial;
            ASSERT_LE(next.norm(), longest * (1.0 + kRounding)) << "trial " << trial;
            ASSERT_LE((next - now).cross(commanded - now).norm(), kRounding) << "trial " << trial;
            ASSERT_LT((commanded - next).norm(), (commanded - now).norm()) << "trial " << trial;
            now = next;
        }
        EXPECT_EQ(now, commanded) << "trial " << trial;
    }
    EXPECT_EQ(limit_change(Vec3(1, 0, 0), Vec3(5, 0, 0), 0.0), Vec3(1, 0, 0));
}

TEST(ForceLimiter, finds_the_point_between_two_that_is_nearest_to_a_third)
{
    const Vec3 from(0, 0, 0);
    const Vec3 to(4, 0, 0);
    EXPECT_EQ(nearest_between(from, to, Vec3(1, 3, 0)), Vec3(1, 0, 0));
    EXPECT_EQ(nearest_between(from, to, Vec3(-1, 3, 0)), from);
    EXPECT_EQ(nearest_between(from, to, Vec3(9, 0, 1)), to);
    EXPECT_EQ(nearest_between(to, to, Vec3(9, 0, 1)), to);
}

TEST(ForceConditioner, lets_a_small_steady_force_through_unchanged)
{
    ForceConditioner sut(plain_setup());
    for (int i = 0; i < 5; ++i)
    {
        const SpringForce out = condition(sut, force(0.5));
        EXPECT_EQ(out.force_n, Vec3(0.5, 0, 0));
        EXPECT_EQ(out.actions, ForceAction::none);
        EXPECT_EQ(out.work_j, 0.0);
    }
}

TEST(ForceConditioner, gives_no_force_for_what_is_no_number_and_recovers)
{
    for (const double bad : {kNan, kInfinite, -kInfinite})
    {
        ForceConditioner sut(plain_setup());
        static_cast<void>(condition(sut, force(1.0)));
        CommandedForce commanded = force(bad);
        EXPECT_EQ(condition(sut, commanded).force_n, Vec3(0, 0, 0));
        EXPECT_TRUE(has_action(condition(sut, commanded).actions, ForceAction::refused));
        commanded = force(1.0);
        commanded.stiffness_n_per_m = bad;
        EXPECT_EQ(condition(sut, commanded).force_n, Vec3(0, 0, 0));
        commanded = force(1.0);
        commanded.position_m.y() = bad;
        const SpringForce blind = condition(sut, commanded);
        EXPECT_EQ(blind.force_n, Vec3(1, 0, 0));
        EXPECT_TRUE(has_action(blind.actions, ForceAction::blind));
        commanded = force(1.0);
        commanded.stretch_m = bad;
        commanded.stiffness_n_per_m = 100.0;
        const SpringForce last = condition(sut, commanded);
        EXPECT_EQ(last.actions, ForceAction::none);
        EXPECT_TRUE(std::isfinite(last.work_j) && std::isfinite(last.observed_energy_j));
    }
    ForceConditioner sut(plain_setup());
    CommandedForce pulling = force(1.0);
    pulling.stiffness_n_per_m = -1.0;
    EXPECT_EQ(condition(sut, pulling).force_n, Vec3(0, 0, 0));
}

TEST(ForceConditioner, counts_the_work_of_what_went_out_in_its_place)
{
    ForceConditioner sut(plain_setup());
    CommandedForce commanded = force(8.0);
    commanded.stiffness_n_per_m = 1'000.0;
    for (int i = 0; i < 20; ++i)
    {
        static_cast<void>(condition(sut, commanded));
    }
    CommandedForce sent = commanded;
    sent.force_n = Vec3(2.0, 0, 0);
    sut.follow(sent.spring(), true);
    commanded.position_m = Vec3(0.001, 0, 0);
    EXPECT_NEAR(condition(sut, commanded).work_j, 0.002, kRounding);
}

TEST(ForceConditioner, a_force_that_a_gain_lets_in_slowly_comes_from_somewhere)
{
    for (const bool is_ramp : {true, false})
    {
        ForceConditioner sut(plain_setup());
        CommandedForce commanded = force(4.0);
        commanded.stiffness_n_per_m = 1'000.0;
        for (int i = 0; i < 20; ++i)
        {
            static_cast<void>(condition(sut, commanded));
            CommandedForce sent = commanded;
            sent.force_n = Vec3(0.2 * i, 0, 0);
            sut.follow(sent.spring(), is_ramp);
        }
        const SpringForce out = condition(sut, commanded);
        EXPECT_EQ(out.force_n, commanded.force_n);
        // The rest without a ramp is the wall's energy that the hand did not supply.
        EXPECT_NEAR(out.observed_energy_j, is_ramp ? 0.0 : 0.5 * 4.0 * 4.0 / 1'000.0, kRounding);
    }
}

/// A moved wall does work on a hand that it carries; that work is its mover's.
TEST(ForceConditioner, takes_no_work_of_those_who_move_a_wall_for_the_walls)
{
    for (const bool is_carried : {true, false})
    {
        ForceConditioner sut(plain_setup());
        double observed_energy_j = 0.0;
        double work_j = 0.0;
        for (int i = 0; i < 100; ++i)
        {
            CommandedForce commanded = force(2.0);
            commanded.stiffness_n_per_m = 1'000.0;
            commanded.position_m = Vec3(4.5e-4 * i, 0, 0);
            commanded.carried_m = is_carried ? Vec3(4.5e-4, 0, 0) : Vec3(0, 0, 0);
            const SpringForce out = condition(sut, commanded);
            observed_energy_j = out.observed_energy_j;
            work_j = out.work_j;
        }
        EXPECT_EQ(observed_energy_j > 0.0, !is_carried) << observed_energy_j;
        EXPECT_GT(work_j, 0.03) << "it is told all the same";
    }
}

TEST(ForceConditioner, counts_the_work_of_a_force_held_through_a_stall)
{
    ForceConditioner sut(plain_setup());
    static_cast<void>(condition(sut, force(1.0)));
    CommandedForce commanded = force(0.5);
    commanded.position_m = Vec3(0.01, 0.02, 0);
    commanded.elapsed_periods = 50;
    EXPECT_NEAR(condition(sut, commanded).work_j, 0.01, kRounding);
    commanded.position_m = Vec3(0.0, 0.02, 0);
    EXPECT_NEAR(condition(sut, commanded).work_j, 0.01 - 0.005, kRounding);
    commanded.elapsed_periods = 0; // Counts as one; 10 m/s is the greatest speed of a device.
    commanded.position_m = Vec3(0.02, 0.02, 0);
    EXPECT_EQ(condition(sut, commanded).actions, ForceAction::blind);
}

TEST(ForceConditioner, sees_nothing_of_a_device_that_is_faster_than_any)
{
    for (const double share : {0.999, 1.001})
    {
        ForceConditioner sut(plain_setup());
        static_cast<void>(condition(sut, force(1.0)));
        CommandedForce commanded = force(1.0);
        commanded.elapsed_periods = 3;
        commanded.position_m.y() = share * kDeviceSpeedMax_m_per_s * 3 * kPeriod_s;
        EXPECT_EQ(has_action(condition(sut, commanded).actions, ForceAction::blind), share > 1.0);
    }
}

TEST(ForceConditioner, says_that_it_sees_wrongly_what_a_long_delay_hides)
{
    for (const double periods : {kForcesUnderWay - 1.01, kForcesUnderWay - 0.99})
    {
        ConditionerSetup setup = plain_setup();
        setup.device.delay_s = periods * kPeriod_s;
        ForceConditioner sut(setup);
        EXPECT_EQ(has_action(condition(sut, force(1.0)).actions, ForceAction::blind),
                  periods > kForcesUnderWay - 1);
    }
}

TEST(ForceConditioner, adds_no_damping_that_makes_less_force_than_the_least)
{
    // A force along the device's motion generates energy: 0.1 N over `way` in the second frame.
    const auto damped_n = [](double way_m)
    {
        ConditionerSetup setup = plain_setup();
        setup.device.damping_n_s_per_m = 0.5;
        setup.device.added_damping_max_n_s_per_m = 1.0;
        ForceConditioner sut(setup);
        CommandedForce commanded = force(0.1);
        commanded.stiffness_n_per_m = 200.0;
        static_cast<void>(condition(sut, commanded));
        commanded.position_m.x() = way_m;
        const SpringForce out = condition(sut, commanded);
        EXPECT_EQ(has_action(out.actions, ForceAction::damped), out.damping_n_s_per_m > 0.0);
        return 0.1 - out.force_n.x();
    };
    EXPECT_EQ(damped_n(0.999 * kLeastDamping_n * kPeriod_s), 0.0);
    EXPECT_NEAR(damped_n(1.001 * kLeastDamping_n * kPeriod_s), 1.001 * kLeastDamping_n, 1e-9);
}

TEST(ForceConditioner, damps_what_came_from_nowhere_and_never_pulls)
{
    Random random(4);
    ConditionerSetup setup = plain_setup();
    setup.device.damping_n_s_per_m = 0.5;
    setup.device.quantum_m = 1e-6;
    ForceConditioner sut(setup);
    std::uint32_t damped = 0;
    double speed = 0.0;
    double x = 0.0;
    std::array<double, 3> places{}; // A wall with two frames of delay generates energy.
    for (int i = 0; i < 5'000; ++i)
    {
        speed = std::clamp(speed + random.between(-0.02, 0.02) - x, -0.3, 0.3);
        x += speed * kPeriod_s;
        places = {x, places[0], places[1]};
        CommandedForce commanded = force(std::max(0.0, -800.0 * places[2]));
        commanded.position_m = Vec3(x, 0, 0);
        commanded.stiffness_n_per_m = 800.0;
        const SpringForce out = condition(sut, commanded);
        const double added = (out.force_n - commanded.force_n).norm();
        ASSERT_GE(out.force_n.x(), -kRounding) << "frame " << i;
        ASSERT_LE(out.force_n.norm(), 10.0 * (1.0 + kRounding)) << "frame " << i;
        ASSERT_LE(out.damping_n_s_per_m, 5.0) << "frame " << i;
        ASSERT_LE(added, 5.0 * 0.31) << "frame " << i;
        ASSERT_EQ(has_action(out.actions, ForceAction::damped), out.damping_n_s_per_m > 0.0);
        ASSERT_TRUE(commanded.force_n.x() > 0.0 || added == 0.0) << "frame " << i;
        damped += out.damping_n_s_per_m > 0.0 ? 1U : 0U;
    }
    EXPECT_GT(damped, 10U);
}

namespace
{

/// Device of 10 N and 0.5 N m, with limits of exactly 3,600 N/m and 1.8 N m/rad.
ConditionerSetup turning_setup()
{
    ConditionerSetup setup = plain_setup();
    setup.device.rotation = {.is_measured = true,
                             .torque_max_nm = 0.5,
                             .inertia_kg_m2 = 1e-4,
                             .damping_nm_s_per_rad = 1e-3,
                             .slew_max_nm_per_s = 1.0,
                             .stiffness_max_nm_per_rad = 3.0,
                             .added_damping_max_nm_s_per_rad = 5e-3};
    return setup;
}

CommandedWrench wrench(const Vec3& force_n, const Vec3& torque_nm, double stiffness = 100.0,
                       double angular = 0.1)
{
    return {{force_n, Vec3(0, 0, 0), stiffness, 0.0, 1},
            {torque_nm, Vec3(0, 0, 0), angular, 0.0, 1}};
}

/// Expects the same gain of force and torque.
void expect_gain(const CommandedWrench& commanded, double gain, ForceAction on_force,
                 ForceAction on_torque)
{
    WrenchConditioner sut(turning_setup());
    const ToolForce out = condition(sut, commanded);
    EXPECT_LT((out.push.force_n - gain * commanded.force.force_n).norm(), kRounding);
    EXPECT_LT((out.torque.force_n - gain * commanded.torque.force_n).norm(), kRounding);
    EXPECT_EQ(out.push.actions, on_force);
    EXPECT_EQ(out.torque.actions, on_torque);
}

} // namespace

TEST(WrenchConditioner, shortens_force_and_torque_by_one_gain)
{
    constexpr ForceAction kNone = ForceAction::none;
    constexpr ForceAction kCapped = ForceAction::stiffness_limited;
    constexpr ForceAction kClamped = ForceAction::clamped;
    const Vec3 force_n(3, 4, 0);
    const Vec3 torque_nm(0, 0, 0.4);
    expect_gain(wrench(force_n, torque_nm), 1.0, kNone, kNone);
    expect_gain(wrench(4.0 * force_n, torque_nm), 0.5, kClamped, kNone);
    expect_gain(wrench(force_n, 5.0 * torque_nm), 0.25, kNone, kClamped);
    expect_gain(wrench(force_n, torque_nm, 7'200.0), 0.5, kCapped, kNone);
    expect_gain(wrench(force_n, torque_nm, 100.0, 9.0), 0.2, kNone, kCapped);
    expect_gain(wrench(Vec3(0, 0, 0), 5.0 * torque_nm), 0.25, kNone, kClamped);
    expect_gain(wrench(4.0 * force_n, Vec3(0, 0, 0)), 0.5, kClamped, kNone);
}

TEST(WrenchConditioner, caps_by_the_damping_of_what_is_touched_and_of_nothing_else)
{
    ConditionerSetup setup = turning_setup();
    setup.lever_max_m = 0.01;
    WrenchConditioner sut(setup);
    const auto force_of = [&sut](double damping_n_s_per_m)
    {
        CommandedWrench commanded = wrench(Vec3(1, 0, 0), Vec3(0, 0, 0.1), 3'600.0, 0.1);
        commanded.force.surface_damping_n_s_per_m = damping_n_s_per_m;
        return condition(sut, commanded).push.force_n.x();
    };
    EXPECT_NEAR(force_of(0.0), 1.0, kRounding);
    // The force changes there and back within the time of a material change, step by step; in free
    // air at once.
    double before = 1.0;
    for (int ms = 1; ms <= 100; ++ms)
    {
        const double force = force_of(ms <= 50 ? 2.0 : 0.0);
        EXPECT_NEAR(force - before, ms <= 50 ? -0.02 : 0.02, 1e-9) << ms;
        before = force;
    }
    EXPECT_NEAR(force_of(0.0), 1.0, kRounding);
    for (int ms = 1; ms <= 50; ++ms)
    {
        before = force_of(1.5);
    }
    EXPECT_NEAR(before, 0.25, kRounding); // 0.9 x 2 (2 - 1.5) / T of 3,600 N/m.
    static_cast<void>(condition(sut, wrench(Vec3(0, 0, 0), Vec3(0, 0, 0))));
    EXPECT_NEAR(force_of(0.0), 1.0, kRounding);
}

TEST(WrenchConditioner, takes_of_the_damping_what_its_lever_makes_of_it_and_half_of_its_own_at_most)
{
    ConditionerSetup setup = turning_setup();
    setup.lever_max_m = 0.02;
    // Damping of 1e-3 N m s/rad: 1.8 N m/rad minus 0.9 x 2 x 4e-4 / T, and half of it for all
    // higher values.
    for (const auto& [damping, limit_nm_per_rad] : {std::pair(1.0, 1.08), std::pair(1.9, 0.9)})
    {
        WrenchConditioner sut(setup);
        CommandedWrench commanded = wrench(Vec3(0, 0, 0), Vec3(0, 0, 0), 100.0, 1.8);
        commanded.force.surface_damping_n_s_per_m = damping;
        static_cast<void>(condition(sut, commanded)); // The hand is in free air.
        commanded.force.force_n = Vec3(1, 0, 0);
        commanded.torque.force_n = Vec3(0, 0, 0.1);
        EXPECT_NEAR(condition(sut, commanded).torque.force_n.z(), 0.1 * limit_nm_per_rad / 1.8,
                    1e-9);
    }
}

TEST(WrenchConditioner, makes_nothing_of_garbage_in_either)
{
    for (const double bad : {kNan, kInfinite})
    {
        for (const CommandedWrench& commanded :
             {wrench(Vec3(1, bad, 0), Vec3(0, 0, 0.1)), wrench(Vec3(1, 0, 0), Vec3(0, bad, 0.1)),
              wrench(Vec3(1, 0, 0), Vec3(0, 0, 0.1), 100.0, bad)})
        {
            WrenchConditioner sut(turning_setup());
            const ToolForce out = condition(sut, commanded);
            EXPECT_EQ(out.push.force_n, Vec3(0, 0, 0));
            EXPECT_EQ(out.torque.force_n, Vec3(0, 0, 0));
            EXPECT_TRUE(has_action(out.push.actions | out.torque.actions, ForceAction::refused));
        }
    }
}

TEST(WrenchConditioner, leaves_the_force_alone_of_a_device_without_a_torque)
{
    ConditionerSetup setup = turning_setup();
    setup.device.rotation.torque_max_nm = 0.0;
    WrenchConditioner sut(setup);
    ForceConditioner point(setup);
    const CommandedWrench commanded = wrench(Vec3(3, 4, 0), Vec3(0, kNan, 1e9));
    for (int i = 0; i < 10; ++i)
    {
        const ToolForce out = condition(sut, commanded);
        EXPECT_EQ(out.push.force_n, condition(point, commanded.force).force_n);
        EXPECT_EQ(out.torque.force_n, Vec3(0, 0, 0));
    }
}

} // namespace tactus::test
