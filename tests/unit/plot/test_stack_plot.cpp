// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/stack_plot.hpp"
#include "tests/shared/markup_reader.hpp"
#include "tests/unit/plot/drawing_text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace tactus::plot::test
{

namespace
{

/// The points of the layers' upper lines, lowest layer first; the legend's samples start with M0.
std::vector<std::vector<Place>> lines_of(const std::string& body)
{
    std::vector<std::vector<Place>> lines;
    for (std::size_t at = body.find("class=\"edge\""); at != std::string::npos;
         at = body.find("class=\"edge\"", at + 1))
    {
        const std::size_t start = body.find(" d=\"M", at) + 5;
        const std::string path = body.substr(start, body.find('"', start) - start);
        if (path == "0 0h26")
        {
            continue;
        }
        std::vector<Place>& line = lines.emplace_back();
        for (const char* point = path.c_str(); *point != '\0';)
        {
            char* end = nullptr;
            const double x = std::strtod(point, &end);
            const double y = std::strtod(end, &end);
            line.push_back({x, y});
            point = *end == 'L' ? end + 1 : end;
        }
    }
    return lines;
}

std::string stack_body(const StackPlot& plot)
{
    const Drawing drawing = draw(plot);
    EXPECT_TRUE(tactus::test::read_markup("<svg>" + drawing.body + "</svg>").has_value());
    EXPECT_EQ(drawing.body.find("nan"), std::string::npos);
    EXPECT_EQ(drawing.body.find("inf"), std::string::npos);
    return drawing.body;
}

TEST(StackPlot, each_layer_stands_on_those_before)
{
    const auto lines = lines_of(stack_body(
        {"t", "frame", "us", {0, 1, 2}, {{"a", {1, 2, 3}}, {"b", {3, 2, 1}}, {"c", {4, 4, 4}}}}));
    ASSERT_EQ(lines.size(), 3U);
    // a 1, 2, 3; a + b 4; all 8, on an axis of 0 to 8 and one pixel scale.
    const double unit = lines[0][0].y - lines[0][1].y;
    EXPECT_GT(unit, 1.0);
    EXPECT_NEAR(lines[0][1].y - lines[0][2].y, unit, 0.11);
    for (std::size_t i = 0; i < 3; ++i)
    {
        EXPECT_NEAR(lines[1][i].y, lines[0][0].y - 3.0 * unit, 0.4);
        EXPECT_NEAR(lines[2][i].y, lines[0][0].y - 7.0 * unit, 0.8);
        EXPECT_EQ(lines[0][i].x, lines[2][i].x);
    }
}

TEST(StackPlot, what_is_not_finite_counts_as_nothing)
{
    const double infinity = std::numeric_limits<double>::infinity();
    const auto lines = lines_of(
        stack_body({"t", "frame", "us", {0, 1}, {{"a", {1.0, infinity}}, {"b", {1.0, 2.0}}}}));
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_GT(lines[0][1].y, lines[0][0].y);
    EXPECT_NEAR(lines[1][0].y, lines[1][1].y, 0.11);
}

TEST(StackPlot, is_sound_with_nothing_in_it)
{
    EXPECT_FALSE(stack_body({"t", "x", "y", {}, {}}).empty());
    EXPECT_FALSE(stack_body({"t", "x", "y", {}, {{"a", {}}}}).empty());
    EXPECT_FALSE(stack_body({"t", "x", "y", {0.0}, {{"a", {0.0}}}}).empty());
    EXPECT_FALSE(stack_body({"t", "x", "y", {0.0, 1.0}, {{"too short", {1.0}}}}).empty());
}

} // namespace

} // namespace tactus::plot::test
