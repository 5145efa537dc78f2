// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/bar_plot.hpp"
#include "tests/shared/markup_reader.hpp"
#include "tests/unit/plot/drawing_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tactus::plot::test
{

namespace
{

TEST(BarPlot, bars_are_as_long_as_their_values)
{
    const Drawing drawing = draw(BarPlot{
        "t", "us", {{"fast", {{"a", 10.0}, {"b", 40.0}}}, {"slow", {{"a", 20.0}, {"c", 0.0}}}}});
    const std::vector<double> lengths = numbers_behind(drawing.body, " width=\"");
    ASSERT_EQ(lengths.size(), 4U);
    EXPECT_NEAR(lengths[1], 4.0 * lengths[0], 0.4);
    EXPECT_NEAR(lengths[2], 2.0 * lengths[0], 0.2);
    EXPECT_EQ(lengths[3], 0.0);
    EXPECT_EQ(count_of(drawing.body, ">40</text>"), 2U); // The value, and a tick.
    EXPECT_EQ(count_of(drawing.body, ">slow</text>"), 1U);
}

TEST(BarPlot, one_name_has_one_colour_in_all_groups)
{
    const Drawing drawing =
        draw(BarPlot{"t", "us", {{"", {{"a", 1.0}, {"b", 1.0}}}, {"", {{"b", 1.0}}}}});
    EXPECT_EQ(count_of(drawing.body, std::string("fill=\"") + Look(1).colour()), 2U);
}

TEST(BarPlot, is_sound_with_anything_in_it)
{
    const double infinity = std::numeric_limits<double>::infinity();
    for (const BarPlot& plot :
         {BarPlot{"", "", {}}, BarPlot{"<&>", "<", {{"<", {{"\"<", infinity}, {"'", 0.0}}}}}})
    {
        const auto read = tactus::test::read_markup(to_svg_element(draw(plot)));
        ASSERT_TRUE(read.has_value());
        EXPECT_EQ(draw(plot).body.find("inf"), std::string::npos);
    }
}

} // namespace

} // namespace tactus::plot::test
