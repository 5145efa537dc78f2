// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/step_plot.hpp"
#include "tests/unit/plot/drawing_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace tactus::plot::test
{

namespace
{

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

/// The numbers behind each letter of this kind.
std::vector<double> numbers_after(const std::string& path, char letter)
{
    std::vector<double> numbers;
    for (std::size_t at = path.find(letter); at != std::string::npos;
         at = path.find(letter, at + 1))
    {
        numbers.push_back(std::strtod(path.c_str() + at + 1, nullptr));
    }
    return numbers;
}

TEST(StepPlot, draws_a_step_for_each_bin_that_is_not_empty)
{
    const std::string path = path_of(make_svg(std::vector{panel_of({5, 0, 1, 100, 0, 0})}));
    EXPECT_EQ(numbers_after(path, 'H').size(), 3U);
    EXPECT_EQ(numbers_after(path, 'M').size(), 2U); // Two islands.
    EXPECT_TRUE(std::ranges::is_sorted(numbers_after(path, 'H')));
}

TEST(StepPlot, draws_more_higher_and_nothing_on_the_base_line)
{
    const std::string path = path_of(make_svg(std::vector{panel_of({1, 10, 100})}));
    const std::vector<double> y = numbers_after(path, 'V'); // Up, up, up, down to the base.
    ASSERT_EQ(y.size(), 4U);
    EXPECT_GT(y[3], y[0]);
    EXPECT_GT(y[0], y[1]);
    EXPECT_NEAR(y[0] - y[1], y[1] - y[2], 0.11); // Decades are alike, to the last digit written.
}

TEST(StepPlot, gives_all_panels_the_same_axis)
{
    std::vector<Panel> panels{panel_of({1}), panel_of({0, 0, 0, 0, 0, 0, 0, 0, 0, 7})};
    const std::string svg = make_svg(panels);
    EXPECT_EQ(count_of(svg, ">1\u2009000</text>"), 2U); // 512 to 1,024 is in the second alone.
    EXPECT_EQ(count_of(svg, ">10\u2009000</text>"), 2U);
}

TEST(StepPlot, draws_marks_where_there_is_room_for_them)
{
    Panel panel = panel_of({1, 1, 1, 1, 1});
    panel.marks = {{10.0, "within"}, {1'000.0, "beyond"}, {0.0, "nowhere"}};
    const std::string svg = make_svg(std::vector{panel});
    EXPECT_EQ(count_of(svg, "class=\"mark\""), 1U);
    EXPECT_EQ(count_of(svg, ">within<"), 1U);
}

TEST(StepPlot, writes_any_name)
{
    Panel panel = panel_of({1});
    panel.title = "a<b & c>d";
    EXPECT_EQ(count_of(make_svg(std::vector{panel}), ">a&lt;b &amp; c&gt;d</text>"), 1U);
}

TEST(StepPlot, is_sound_with_nothing_in_it)
{
    for (const std::vector<Panel>& panels :
         {std::vector<Panel>{}, {panel_of({})}, {panel_of({0, 0})}})
    {
        const std::string svg = make_svg(panels);
        EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        EXPECT_EQ(svg.find("nan"), std::string::npos);
        EXPECT_EQ(svg.find("inf"), std::string::npos);
    }
}

} // namespace

} // namespace tactus::plot::test
