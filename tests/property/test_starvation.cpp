// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A tool in contact has the same force for any behaviour of the others, which share its model,
/// pools and frame budgets.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/greedy_tools.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/trial_length.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace tactus::test
{
namespace
{

class Starvation : public testing::TestWithParam<GreedyCase>
{
};

TEST_P(Starvation, a_touch_stays_exact_and_is_not_data_limited)
{
    const TestModel& model =
        test_model("bumpy-200k", make_shape(Shape::bumpy_sphere, 200'000).value(), 500);
    const std::uint64_t seed = seed_of(2'310);
    SCOPED_TRACE("seed " + std::to_string(seed));

    const GreedyFigures figures = run_greedy(model, GetParam(), trial_length(1'000), seed);

    ASSERT_GT(figures.frames, trial_length(300));
    EXPECT_EQ(figures.broken, "");
    EXPECT_LE(figures.splits_max, GetParam().splits);
    EXPECT_EQ(figures.exact, figures.frames);
    const bool shares_contact = GetParam().others == GreedyCase::Others::are_held;
    EXPECT_LE(figures.data_limited_percent(), shares_contact ? 5.0 : 0.0);
    EXPECT_LE(figures.force_step_n, shares_contact ? 0.1 : 0.05);
}

/// The greatest number of tools, all but one greedy, in a scene of 100 objects.
TEST(StarvationOfMany, sixteen_tools_among_a_hundred_objects_leave_a_touch_as_it_is_when_alone)
{
    const TestModel& model =
        test_model("bumpy-200k", make_shape(Shape::bumpy_sphere, 200'000).value(), 500);
    const std::uint64_t seed = seed_of(2'312);
    SCOPED_TRACE("seed " + std::to_string(seed));
    GreedyCase greedy{"alone", GreedyCase::Others::none};
    greedy.tools = kMaxTools - 1;
    greedy.objects = 100;
    const GreedyFigures alone = run_greedy(model, greedy, trial_length(600), seed);
    ASSERT_GT(alone.frames, trial_length(200));
    EXPECT_EQ(alone.exact, alone.frames);
    for (const auto others : {GreedyCase::Others::pass, GreedyCase::Others::teleport})
    {
        greedy.others = others;
        greedy.operators_diag_per_s = 4.0;
        const GreedyFigures among_others = run_greedy(model, greedy, trial_length(600), seed);
        EXPECT_EQ(among_others.broken, "");
        EXPECT_EQ(among_others.frames, alone.frames);
        EXPECT_EQ(among_others.exact, among_others.frames);
        EXPECT_EQ(among_others.data_limited, 0U);
        EXPECT_LE(among_others.splits_max, greedy.splits);
        EXPECT_NEAR(among_others.force_step_n, alone.force_step_n, 1e-9);
    }
}

/// Pools that hardly hold one touch: the other tools give theirs up, and the frame reports it.
TEST(Shedding, begins_where_a_touch_finds_no_room_and_is_told)
{
    const TestModel& model =
        test_model("bumpy-200k", make_shape(Shape::bumpy_sphere, 200'000).value(), 500);
    const std::uint64_t seed = seed_of(2'311);
    SCOPED_TRACE("seed " + std::to_string(seed));
    GreedyCase greedy{"tight", GreedyCase::Others::pass, 4.0};
    greedy.pool_bytes = std::size_t{1'150} << 10U;
    const GreedyFigures among_others = run_greedy(model, greedy, 1'000, seed);
    greedy.others = GreedyCase::Others::none;
    const GreedyFigures alone = run_greedy(model, greedy, 1'000, seed);

    EXPECT_EQ(among_others.broken, "");
    EXPECT_GT(among_others.shed, 300U);
    EXPECT_EQ(among_others.exact, among_others.frames);
    EXPECT_LE(among_others.data_limited_percent(), 1.0);
    EXPECT_EQ(alone.shed, 0U) << "there is nobody else";
    EXPECT_EQ(alone.exact, alone.frames);
}

std::string name_of_others(const testing::TestParamInfo<GreedyCase>& info)
{
    std::string name = info.param.name;
    std::ranges::replace_if(
        name, [](char letter) { return std::isalnum(static_cast<unsigned char>(letter)) == 0; },
        '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Others, Starvation, testing::ValuesIn(greedy_cases()), name_of_others);

} // namespace
} // namespace tactus::test
