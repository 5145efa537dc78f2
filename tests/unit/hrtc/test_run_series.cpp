// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/run_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

namespace tactus::hrtc::test
{

namespace
{

SeriesPoint random_point(std::mt19937& random)
{
    std::uniform_real_distribution<float> values(0.0F, 100.0F);
    SeriesPoint point{.force_n = values(random),
                      .width_m = values(random),
                      .frame_us = values(random),
                      .stage_us = {}};
    std::ranges::generate(point.stage_us, [&] { return values(random); });
    return point;
}

/// Maximum of each `stride` numbers.
std::vector<float> largest(const std::vector<float>& values, std::size_t stride)
{
    std::vector<float> result;
    for (std::size_t first = 0; first < values.size(); first += stride)
    {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end =
            values.begin() + static_cast<std::ptrdiff_t>(std::min(first + stride, values.size()));
        result.push_back(*std::max_element(begin, end));
    }
    return result;
}

/// One value of every point or frame.
template <typename Value>
std::vector<float> all_of(const std::vector<SeriesPoint>& points, Value value_of)
{
    std::vector<float> values;
    for (const SeriesPoint& point : points)
    {
        values.push_back(value_of(point));
    }
    return values;
}

TEST(RunSeries, each_point_is_the_worst_of_its_frames)
{
    std::mt19937 random(2031);
    std::vector<SeriesPoint> frames;
    RunSeries series;
    EXPECT_TRUE(series.points().empty());
    // Counts around each doubling, and while pairs are being merged.
    const std::vector<std::size_t> looks{1,     2,     2'047, 2'048, 2'049, 2'050, 3'000, 3'072,
                                         3'073, 4'095, 4'096, 4'097, 5'121, 8'192, 8'193, 20'000};
    for (const std::size_t count : looks)
    {
        while (frames.size() < count)
        {
            frames.push_back(random_point(random));
            series.add(frames.back());
        }
        SCOPED_TRACE(count);
        const auto stride = static_cast<std::size_t>(series.stride());
        const std::vector<SeriesPoint> points = series.points();
        EXPECT_LE(points.size(), RunSeries::kPoints);
        EXPECT_TRUE(stride == 1 || points.size() > RunSeries::kPoints / 2);
        EXPECT_EQ(points.size(), (count + stride - 1) / stride);
        const auto agree = [&](auto value_of)
        { return all_of(points, value_of) == largest(all_of(frames, value_of), stride); };
        EXPECT_TRUE(agree([](const SeriesPoint& point) { return point.force_n; }));
        EXPECT_TRUE(agree([](const SeriesPoint& point) { return point.width_m; }));
        EXPECT_TRUE(agree([](const SeriesPoint& point) { return point.frame_us; }));
        for (std::size_t stage = 0; stage < kStages; ++stage)
        {
            EXPECT_TRUE(agree([stage](const SeriesPoint& point) { return point.stage_us[stage]; }))
                << "stage " << stage;
        }
    }
}

TEST(ToolPath, has_of_neighbouring_frames_the_place_with_the_most_force)
{
    ToolPath path;
    for (int i = 0; i < 5'000; ++i)
    {
        path.add({{static_cast<float>(i), 0.0F, 0.0F}, i % 4 == 2 ? 1.0F : 0.25F});
    }
    ASSERT_EQ(path.stride(), 4U);
    const std::vector<PathPoint> points = path.points();
    ASSERT_EQ(points.size(), 1'250U);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        EXPECT_EQ(points[i], (PathPoint{{static_cast<float>(4 * i + 2), 0.0F, 0.0F}, 1.0F})) << i;
    }
}

} // namespace

} // namespace tactus::hrtc::test
