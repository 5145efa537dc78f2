// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/limits.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace tactus::test
{

namespace
{

DeviceLimits some_device()
{
    DeviceLimits device;
    device.damping_n_s_per_m = 2.0;
    device.stiffness_max_n_per_m = 1e6;
    return device;
}

/// Greatest share of K v^2, averaged over time, that a spring generates when its force, held for a
/// period of 1, is delayed by `delay`: over all piecewise constant motions with a phase between
/// periods. Half the spectral radius of "x(t) - x at the time of the sample in force".
double largest_share_given_away(double delay)
{
    constexpr int kPieces = 24;
    double largest = 0.0;
    for (int turn = 0; turn <= 36; ++turn)
    {
        const double phase = std::numbers::pi * turn / 36.0;
        Eigen::MatrixXcd moved = Eigen::MatrixXcd::Zero(kPieces, kPieces);
        for (int i = 0; i < kPieces; ++i)
        {
            const double at = (i + 0.5) / kPieces;
            const double held = at - delay - std::floor(at - delay);
            const int sampled = static_cast<int>(std::lround((at - delay - held) * kPieces));
            for (int j = sampled; j < i; ++j)
            {
                const int period = j >= 0 ? 0 : -((kPieces - 1 - j) / kPieces);
                moved(i, j - period * kPieces) += std::polar(1.0 / kPieces, phase * period);
            }
            moved(i, i) += 0.5 / kPieces;
        }
        const Eigen::MatrixXcd power = 0.5 * (moved + moved.adjoint());
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(power, Eigen::EigenvaluesOnly);
        largest = std::max(largest, solver.eigenvalues()[kPieces - 1]);
    }
    return largest;
}

} // namespace

TEST(StiffnessRule, gives_the_numbers_of_a_calculation_by_hand)
{
    DeviceLimits device = some_device();
    EXPECT_DOUBLE_EQ(stiffness_limits(device, 1e-3).sampling_n_per_m, 4'000.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(device, 1e-3), 3'600.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(device, 0.25e-3), 14'400.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(device, 1e-3, 0.5), 2'700.0);
    device.delay_s = 1e-3;
    EXPECT_DOUBLE_EQ(stiffness_limit(device, 1e-3), 1'200.0);
    device.friction_n = 0.01;
    device.quantum_m = 20e-6;
    EXPECT_DOUBLE_EQ(stiffness_limits(device, 1e-3).quantisation_n_per_m, 1'000.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(device, 1e-3), 900.0);
    // 0.1 N s/m x 20 um a ms is 0.002 N of noise.
    EXPECT_DOUBLE_EQ(stiffness_limits(device, 1e-3, -0.1).quantisation_n_per_m, 800.0);
    device.stiffness_max_n_per_m = 500.0;
    EXPECT_DOUBLE_EQ(stiffness_limit(device, 1e-3), 500.0);
}

TEST(StiffnessRule, leaves_nothing_where_surface_damping_takes_all)
{
    EXPECT_EQ(stiffness_limit(some_device(), 1e-3, 2.0), 0.0);
    EXPECT_EQ(stiffness_limit(some_device(), 1e-3, 3.0), 0.0);
    EXPECT_EQ(stiffness_limit(some_device(), 1e-3, -3.0), 0.0);
}

TEST(StiffnessRule, knows_no_quantisation_limit_without_friction_or_quantum)
{
    DeviceLimits device = some_device();
    device.quantum_m = 1e-5;
    EXPECT_EQ(stiffness_limits(device, 1e-3).quantisation_n_per_m,
              std::numeric_limits<double>::infinity());
    device.friction_n = 0.1;
    device.quantum_m = 0.0;
    EXPECT_EQ(stiffness_limit(device, 1e-3), 3'600.0);
}

TEST(StiffnessRule, is_exact_for_whole_periods_of_delay_and_within_its_margin_for_others)
{
    double worst = 0.0;
    for (const double delay : {0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0, 1.25, 2.0})
    {
        const double predicted = 0.5 + delay;
        const double ratio = largest_share_given_away(delay) / predicted;
        std::printf("delay %.3f periods: gives away %.4f of what the rule says\n", delay, ratio);
        const bool is_whole = delay == std::floor(delay);
        // Pieces are 1/24 of a period long.
        EXPECT_NEAR(ratio, 1.0, is_whole ? 1e-9 : 0.09) << delay;
        EXPECT_LT(ratio * kStiffnessMargin, 1.0) << delay;
        worst = std::max(worst, ratio);
    }
    EXPECT_GT(worst, 1.05); // Otherwise the margin's reason in limits.hpp is wrong.
}

TEST(StiffnessRule, names_the_value_that_is_out_of_range)
{
    EXPECT_EQ(find_fault(DeviceLimits{}), nullptr);
    using Member = double DeviceLimits::*;
    const std::pair<Member, const char*> members[] = {
        {&DeviceLimits::mass_kg, "mass_kg"},
        {&DeviceLimits::damping_n_s_per_m, "damping_n_s_per_m"},
        {&DeviceLimits::friction_n, "friction_n"},
        {&DeviceLimits::quantum_m, "quantum_m"},
        {&DeviceLimits::delay_s, "delay_s"},
        {&DeviceLimits::force_max_n, "force_max_n"},
        {&DeviceLimits::slew_max_n_per_s, "slew_max_n_per_s"},
        {&DeviceLimits::stiffness_max_n_per_m, "stiffness_max_n_per_m"},
        {&DeviceLimits::added_damping_max_n_s_per_m, "added_damping_max_n_s_per_m"}};
    for (const auto& [member, name] : members)
    {
        for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity()})
        {
            DeviceLimits device;
            device.*member = bad;
            const char* fault = find_fault(device);
            ASSERT_NE(fault, nullptr) << name << " " << bad;
            EXPECT_NE(std::string(fault).find(name), std::string::npos) << fault;
        }
    }
}

} // namespace tactus::test
