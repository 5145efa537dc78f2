// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// What a reader of a page goes by: figures are drawn to scale and named by the right numbers.

#include "platform/plot/bar_plot.hpp"
#include "platform/plot/step_plot.hpp"
#include "tests/shared/count_of.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace tactus::plot::test
{

namespace
{

using tactus::test::count_of;

/// The number behind each of these.
std::vector<double> numbers_behind(const std::string& text, const std::string& part)
{
    std::vector<double> numbers;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    {
        numbers.push_back(std::strtod(text.c_str() + at + part.size(), nullptr));
    }
    return numbers;
}

Panel panel_of(const std::vector<double>& counts)
{
    std::vector<double> edges{1.0};
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
        edges.push_back(2.0 * edges.back());
    }
    return {"title", "us", "cycles", {{"run", edges, counts}}, {}};
}

/// The `d` of the one line of steps; the legend's comes before.
std::string path_of(const std::string& svg)
{
    const std::size_t at = svg.rfind(" d=\"") + 4;
    return svg.substr(at, svg.find('"', at) - at);
}

TEST(NumberText, is_short_and_true)
{
    EXPECT_EQ(number_text(0.0), "0");
    EXPECT_EQ(number_text(12.5), "12.5");
    EXPECT_EQ(number_text(-1'234.0), "-1\u2009234");
    EXPECT_EQ(number_text(1e-4), "0.0001");
    EXPECT_EQ(number_text(9.9999e4), "99\u2009999");
    EXPECT_EQ(number_text(1e6), "10\u2076");
    EXPECT_EQ(number_text(2.5e-6), "2.5\u00D710\u207B\u2076");
    EXPECT_EQ(number_text(9.9999e-6), "10\u207B\u2075");
    EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "none");
}

TEST(StepPlot, draws_more_higher_and_nothing_on_the_base_line)
{
    const std::string path = path_of(make_svg(std::vector{panel_of({1, 10, 100, 0, 5})}));
    EXPECT_EQ(numbers_behind(path, "M").size(), 2U); // Two islands,
    EXPECT_EQ(numbers_behind(path, "H").size(), 4U); // of four steps.
    const std::vector<double> y = numbers_behind(path, "V");
    ASSERT_EQ(y.size(), 6U); // Up, up, up, down to the base; up, down.
    EXPECT_GT(y[3], y[0]);
    EXPECT_GT(y[0], y[1]);
    EXPECT_NEAR(y[0] - y[1], y[1] - y[2], 0.11); // Decades are alike, to the last digit written.
    EXPECT_EQ(y[3], y[5]);
}

TEST(StepPlot, gives_all_panels_the_same_axis_and_marks_what_is_on_it)
{
    std::vector<Panel> panels{panel_of({1}), panel_of({0, 0, 0, 0, 0, 0, 0, 0, 0, 7})};
    panels[0].marks = {{10.0, "within"}, {100'000.0, "beyond"}, {0.0, "nowhere"}};
    const std::string svg = make_svg(panels);
    EXPECT_EQ(count_of(svg, ">1\u2009000</text>"), 2U); // 512 to 1,024 is in the second alone.
    EXPECT_EQ(count_of(svg, "class=\"mark\""), 1U);
    EXPECT_EQ(count_of(svg, ">within<"), 1U);
}

TEST(StepPlot, is_sound_with_nothing_in_it)
{
    for (const std::vector<Panel>& panels :
         {std::vector<Panel>{}, {panel_of({})}, {panel_of({0, 0})}})
    {
        const std::string svg = make_svg(panels);
        EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0U);
    }
}

TEST(BarPlot, bars_are_as_long_as_their_values)
{
    const double infinity = std::numeric_limits<double>::infinity();
    const Drawing drawing = draw(BarPlot{"t",
                                         "us",
                                         {{"fast", {{"a", 10.0}, {"b", 40.0}}},
                                          {"slow", {{"a", 20.0}, {"c", 0.0}, {"d", infinity}}}}});
    const std::vector<double> lengths = numbers_behind(drawing.body, " width=\"");
    ASSERT_EQ(lengths.size(), 5U);
    EXPECT_NEAR(lengths[1], 4.0 * lengths[0], 0.4);
    EXPECT_NEAR(lengths[2], 2.0 * lengths[0], 0.2);
    EXPECT_EQ(lengths[3], 0.0);
    EXPECT_EQ(lengths[4], 0.0);
    EXPECT_EQ(count_of(drawing.body, ">40</text>"), 2U); // The value, and a tick.
    EXPECT_EQ(count_of(drawing.body, ">slow</text>"), 1U);
    EXPECT_EQ(count_of(drawing.body, ">none</text>"), 1U);
}

} // namespace

} // namespace tactus::plot::test
