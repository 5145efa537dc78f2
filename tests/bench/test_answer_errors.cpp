// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/answer_errors.hpp"
#include "tests/bench/growth_case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::bench
{

namespace
{

const Vec3 kNowhere(0.0, 0.0, 0.0);

/// A large triangle in the plane z = 0, of a model with a diagonal of 1 m, and a probe of 0.1 m.
struct Plane
{
    std::vector<test::Face> faces{
        test::Face{{{-10.0F, -10.0F, 0.0F}, {10.0F, -10.0F, 0.0F}, {0.0F, 10.0F, 0.0F}}}};
    test::FaceTree tree{faces};
    TrueAnswers truth{tree, 1.0, {Vec3(0.0, 0.0, 0.08), Vec3(0.0, 0.0, 0.3)}, 0.1};
};

TEST(AnswerErrors, of_the_truth_are_none)
{
    const AnswerErrors errors =
        Plane().truth.errors_of({{0.08, Vec3(0.0, 0.0, 0.0), true}, {0.3, kNowhere, false}});

    EXPECT_NEAR(errors.distance_diag.max, 0.0, 1e-12);
    EXPECT_NEAR(errors.normal_deg.max, 0.0, 1e-6);
    EXPECT_NEAR(errors.force_n.max, 0.0, 1e-9);
    EXPECT_EQ(errors.touch.missed + errors.touch.invented, 0U);
}

TEST(AnswerErrors, count_distances_up_to_the_radius)
{
    const AnswerErrors errors =
        Plane().truth.errors_of({{0.09, Vec3(0.0, 0.0, -0.01), true}, {0.2, kNowhere, false}});

    EXPECT_NEAR(errors.distance_diag.max, 0.01, 1e-12);
    EXPECT_NEAR(errors.force_n.max, 500.0 * 0.01 * 0.2, 1e-9);
}

TEST(AnswerErrors, tell_a_turned_normal_and_its_force)
{
    const double turned = 0.1;
    const Vec3 nearest(0.08 * std::sin(turned), 0.0, 0.08 - 0.08 * std::cos(turned));
    const AnswerErrors errors =
        Plane().truth.errors_of({{0.08, nearest, true}, {0.3, kNowhere, false}});

    EXPECT_NEAR(errors.normal_deg.max, turned * 180.0 / std::acos(-1.0), 1e-6);
    EXPECT_NEAR(errors.force_n.max, 500.0 * 0.02 * 0.2 * 2.0 * std::sin(0.5 * turned), 1e-9);
}

TEST(AnswerErrors, count_missed_and_invented_contacts)
{
    const AnswerErrors errors =
        Plane().truth.errors_of({{std::numeric_limits<double>::infinity(), kNowhere, false},
                                 {0.05, Vec3(0.0, 0.0, 0.25), true}});

    EXPECT_EQ(errors.touch.missed, 1U);
    EXPECT_EQ(errors.touch.invented, 1U);
    EXPECT_NEAR(errors.distance_diag.max, 0.05, 1e-12);
}

TEST(AnswerErrors, take_a_bracket_by_its_middle_and_a_nearest_point_by_itself)
{
    PairOutput pair;
    pair.point_m = Vec3(0.0, 0.0, 1.0);
    pair.lower_m = 1.0;
    pair.upper_m = 3.0;
    EXPECT_EQ(answer_of(pair).distance_m, 2.0);
    EXPECT_FALSE(answer_of(pair).has_nearest);
    pair.upper_m = std::numeric_limits<double>::infinity();
    EXPECT_EQ(answer_of(pair).distance_m, 1.0);
    pair.nearest_face = FaceId{7};
    EXPECT_EQ(answer_of(pair).distance_m, 1.0);
    EXPECT_TRUE(answer_of(pair).has_nearest);
}

TEST(Growth, exponents_are_those_of_the_power_law)
{
    const std::vector<double> n{10.0, 100.0, 1'000.0};
    EXPECT_NEAR(fitted_exponent(n, {3.0, 30.0, 300.0}), 1.0, 1e-12);
    EXPECT_NEAR(fitted_exponent(n, {7.0, 7.0, 7.0}), 0.0, 1e-12);
    EXPECT_NEAR(fitted_exponent(n, {1.0, 0.1, 0.01}), -1.0, 1e-12);
}

} // namespace

} // namespace tactus::bench
