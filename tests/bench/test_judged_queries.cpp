// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/infinity.hpp"
#include "tests/bench/judged_queries.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tactus::bench
{

namespace
{

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(JudgeTouch, counts_what_is_planted)
{
    constexpr double kRadius = 1.0;
    constexpr double kTolerance = 0.01;
    const std::vector<double> truth{0.5, 0.5, 0.5, 1.5, 1.5, 1.5};
    const std::vector<double> told{0.9, 1.1, kInfinity, 1.1, 0.9, 0.99};

    const TouchErrors errors = judge_touch(told, truth, kRadius, kTolerance);

    EXPECT_EQ(errors.missed, 2U);
    EXPECT_EQ(errors.invented, 2U);
}

TEST(JudgeTouch, lets_pass_what_is_near_the_radius_and_takes_no_number_for_no)
{
    const std::vector<double> truth{0.995, 1.005, 0.5, 1.5};
    const std::vector<double> told{1.5, 0.5, kNotANumber, kNotANumber};

    const TouchErrors errors = judge_touch(told, truth, 1.0, 0.01);

    EXPECT_EQ(errors.missed, 1U);
    EXPECT_EQ(errors.invented, 0U);
}

TEST(LargestError, counts_up_to_the_band)
{
    const std::vector<double> truth{1.0, 1.9, 5.0, 5.0};
    const std::vector<double> told{1.25, kInfinity, kInfinity, 3.0};
    const std::vector<double> bands{2.0, 2.0, 2.0, 2.0};

    EXPECT_DOUBLE_EQ(largest_error_m(told, truth, bands), 0.25);
    const std::vector<double> wide{kInfinity, 2.0, 2.0, kInfinity};
    EXPECT_DOUBLE_EQ(largest_error_m(told, truth, wide), 2.0);
}

TEST(LargestError, is_infinite_for_what_is_no_number_and_for_what_was_not_found)
{
    const std::vector<double> truth{1.0, 1.0};
    const std::vector<double> bands{kInfinity, kInfinity};
    EXPECT_EQ(largest_error_m(std::vector{kNotANumber, 1.0}, truth, bands), kInfinity);
    EXPECT_EQ(largest_error_m(std::vector{1.0, kInfinity}, truth, bands), kInfinity);
    EXPECT_EQ(largest_error_m({}, {}, {}), 0.0);
}

TEST(LargestPointError, sees_points_beside_the_surface_and_points_too_far_away)
{
    const std::vector<test::Face> faces{
        {Vec3f{-9.0F, -9.0F, 0.0F}, Vec3f{9.0F, -9.0F, 0.0F}, Vec3f{0.0F, 9.0F, 0.0F}}};
    const test::FaceTree tree(faces);
    const Questions questions{{Vec3(0, 0, 1)}, {1.0}};
    const auto error_of = [&](const Vec3& told_m, double distance_m)
    {
        return largest_point_error_m({LeastTimes(1), {distance_m}, {told_m}, 0, std::nullopt},
                                     questions, tree);
    };

    EXPECT_EQ(error_of(Vec3(0, 0, 0), 1.0), 0.0);
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0, 0.25), 1.0), 0.25);
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0, 2), 1.0), 2.0); // As near, but not on the surface.
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0.75, 0), 1.0), 0.25);
    EXPECT_EQ(error_of(Vec3(5, 5, 5), kInfinity), 0.0); // Nothing was told.
}

} // namespace

} // namespace tactus::bench
