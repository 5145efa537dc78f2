// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/stage_series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

namespace tactus::bench
{

namespace
{

using Times = std::array<std::vector<double>, kSeriesStages>;

Times times_of(std::size_t frames)
{
    Times us;
    us.fill(std::vector<double>(frames, 1.0));
    return us;
}

TEST(StageSeries, few_frames_are_a_point_each)
{
    Times us = times_of(3);
    us[2] = {4.0, 5.0, 6.0};
    Row common;
    common.suite = "frame";
    common.test_case = "tiny";

    const StageSeries sut = make_series(common, us);

    EXPECT_EQ(sut.suite, "frame");
    EXPECT_EQ(sut.test_case, "tiny");
    EXPECT_EQ(sut.frames, (std::vector{0.0, 1.0, 2.0}));
    EXPECT_EQ(sut.us, us);
}

TEST(StageSeries, no_peak_is_lost_and_a_point_is_one_frame)
{
    constexpr std::size_t kSamples = 1'999;
    for (const std::size_t peak : {0U, 1U, 2U, 777U, 1'997U, 1'998U})
    {
        Times us = times_of(kSamples);
        us[1][peak] = 50.0;
        us[3][peak] = 0.5;

        const StageSeries sut = make_series({}, us);

        ASSERT_LE(sut.frames.size(), StageSeries::kPointsMax);
        const auto highest = std::ranges::max_element(sut.us[1]) - sut.us[1].begin();
        const auto place = static_cast<std::size_t>(highest);
        EXPECT_EQ(sut.us[1][place], 50.0) << peak;
        EXPECT_EQ(sut.us[3][place], 0.5) << peak;
        EXPECT_LE(sut.frames[place], static_cast<double>(peak));
        EXPECT_GT(sut.frames[place] + 4.0, static_cast<double>(peak));
        EXPECT_EQ(std::ranges::count(sut.us[1], 50.0), 1) << peak;
    }
}

TEST(StageSeries, ends_with_the_last_frame_that_it_may_show)
{
    Times us = times_of(StageSeries::kFramesMax + 10);
    us[0][StageSeries::kFramesMax - 1] = 7.0;
    us[0][StageSeries::kFramesMax] = 9.0;

    const StageSeries sut = make_series({}, us);

    EXPECT_LE(sut.frames.size(), StageSeries::kPointsMax);
    EXPECT_EQ(std::ranges::max(sut.us[0]), 7.0);
    EXPECT_EQ(std::ranges::count(sut.us[0], 7.0), 1);
}

TEST(StageSeries, of_no_frames_is_empty)
{
    const StageSeries sut = make_series({}, times_of(0));
    EXPECT_TRUE(sut.frames.empty());
    EXPECT_TRUE(sut.us[0].empty());
}

} // namespace

} // namespace tactus::bench
