// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/line_plot.hpp"
#include "tests/shared/markup_reader.hpp"
#include "tests/unit/plot/drawing_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <random>
#include <set>

namespace tactus::plot::test
{

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

LinePlot plot_of(std::vector<Line> lines, bool is_logarithmic = true)
{
    return {"title", {"error, m", is_logarithmic}, {"time, us", is_logarithmic}, std::move(lines)};
}

std::string body_of(const LinePlot& plot)
{
    const Drawing drawing = draw(plot);
    EXPECT_TRUE(tactus::test::read_markup("<svg>" + drawing.body + "</svg>").has_value());
    EXPECT_EQ(drawing.body.find("nan"), std::string::npos);
    EXPECT_EQ(drawing.body.find("inf"), std::string::npos);
    return drawing.body;
}

/// Without the legend's sample, which comes first.
std::vector<Place> data_of(const std::string& body, std::size_t line)
{
    std::vector<Place> places = markers_of(body, Look(line).colour());
    places.erase(places.begin());
    return places;
}

TEST(LinePlot, decades_are_alike_on_both_axes)
{
    const auto places = data_of(
        body_of(plot_of({{"a", {{1e-4, 1'000.0, ""}, {1e-3, 100.0, ""}, {1e-2, 10.0, ""}}}})), 0);
    ASSERT_EQ(places.size(), 3U);
    EXPECT_NEAR(places[1].x - places[0].x, places[2].x - places[1].x, 0.11);
    EXPECT_NEAR(places[1].y - places[0].y, places[2].y - places[1].y, 0.11);
    EXPECT_GT(places[1].x, places[0].x);
    EXPECT_GT(places[1].y, places[0].y); // Less is lower.
}

TEST(LinePlot, zero_on_a_logarithmic_axis_stands_left_of_a_marked_border)
{
    const std::string body = body_of(plot_of({{"a", {{0.0, 5.0, ""}, {1e-6, 2.0, ""}}}}));
    const auto places = data_of(body, 0);
    ASSERT_EQ(places.size(), 2U);
    const std::vector<double> border = numbers_behind(body, "<line class=\"mark\" x1=\"");
    ASSERT_EQ(border.size(), 1U);
    EXPECT_LT(places[0].x + 4.0, border[0]);
    EXPECT_GE(places[1].x, border[0] - 0.11);
    EXPECT_EQ(count_of(body, ">0</text>"), 1U);
}

TEST(LinePlot, leaves_out_what_has_no_place)
{
    const std::string body =
        body_of(plot_of({{"a",
                          {{1.0, 1.0, ""},
                           {kNan, 1.0, ""},
                           {1.0, -1.0, ""},
                           {3.0, std::numeric_limits<double>::infinity(), ""}}}}));
    EXPECT_EQ(data_of(body, 0).size(), 1U);
}

TEST(LinePlot, each_line_has_colour_dash_and_marker)
{
    std::vector<Line> lines;
    std::set<std::string> looks;
    for (std::size_t i = 0; i < 40; ++i)
    {
        lines.push_back({"line " + std::to_string(i), {{1.0, 1.0, ""}, {2.0, 2.0, ""}}});
        looks.insert(Look(i).stroke() + Look(i).marker(0.0, 0.0, ""));
    }
    EXPECT_EQ(looks.size(), 40U);
    const std::string body = body_of(plot_of(lines, false));
    for (const Line& line : lines)
    {
        EXPECT_EQ(count_of(body, ">" + line.name + "</text>"), 1U);
    }
}

TEST(LinePlot, a_guide_is_dotted_and_has_no_markers)
{
    const std::string body = body_of(plot_of({{"law", {{1.0, 1.0, ""}, {10.0, 10.0, ""}}, true}}));
    EXPECT_EQ(count_of(body, "class=\"marker\""), 0U);
    EXPECT_EQ(count_of(body, "stroke-dasharray=\"1.5 4\""), 2U); // And in the legend.
}

TEST(LinePlot, every_point_tells_its_label_and_the_ends_show_it)
{
    const std::string body = body_of(
        plot_of({{"a", {{1.0, 1.0, "K 1"}, {10.0, 10.0, "K 64"}, {100.0, 100.0, "K 128"}}}}));
    EXPECT_EQ(count_of(body, "<title>a, K 64: 10, 10</title>"), 1U);
    EXPECT_EQ(count_of(body, ">K 1</text>"), 1U);
    EXPECT_EQ(count_of(body, ">K 64</text>"), 0U);
    EXPECT_EQ(count_of(body, ">K 128</text>"), 1U);
}

/// Texts beside points: where they start, and how many characters they have.
struct Note
{
    Place at;
    std::size_t characters;

    [[nodiscard]] double right() const { return at.x + 6.0 * static_cast<double>(characters); }
};

std::vector<Note> notes_of(const std::string& body)
{
    const std::string start = "<text class=\"note\" x=\"";
    std::vector<Note> notes;
    for (std::size_t at = body.find(start); at != std::string::npos; at = body.find(start, at + 1))
    {
        const std::size_t text = body.find('>', at) + 1;
        notes.push_back({{std::strtod(body.c_str() + at + start.size(), nullptr),
                          std::strtod(body.c_str() + body.find(" y=\"", at) + 4, nullptr)},
                         body.find('<', text) - text});
    }
    return notes;
}

TEST(LinePlot, labels_keep_off_markers_and_one_another)
{
    constexpr unsigned kSeed = 8'112'026;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> value(1.0, 1'000.0);
    std::size_t seen = 0;
    for (int trial = 0; trial < 200; ++trial)
    {
        std::vector<Line> lines;
        std::vector<Place> markers;
        for (int i = 0; i < 4; ++i)
        {
            Line line{"line", {}};
            for (int k = 0; k < 6; ++k)
            {
                line.points.push_back({value(random), value(random), "K 1234"});
            }
            lines.push_back(line);
        }
        const std::string body = body_of(plot_of(lines, trial % 2 == 0));
        for (std::size_t i = 0; i < lines.size(); ++i)
        {
            std::ranges::copy(data_of(body, i), std::back_inserter(markers));
        }
        const std::vector<Note> notes = notes_of(body);
        seen += notes.size();
        for (const Note& note : notes)
        {
            for (const Place& marker : markers)
            {
                const bool is_covered = marker.x > note.at.x && marker.x < note.right() &&
                                        marker.y > note.at.y - 10.0 && marker.y < note.at.y + 2.0;
                ASSERT_FALSE(is_covered) << trial;
            }
            for (const Note& other : notes)
            {
                const bool is_over = &other != &note && other.at.x < note.right() &&
                                     note.at.x < other.right() &&
                                     std::abs(note.at.y - other.at.y) < 11.0;
                ASSERT_FALSE(is_over) << trial;
            }
        }
    }
    EXPECT_GT(seen, 200U); // They are not just left out.
}

TEST(LinePlot, the_legend_grows_above_the_frame)
{
    const std::vector<Point> points{{1.0, 1.0, ""}, {2.0, 2.0, ""}};
    const double low = draw(plot_of({{"short", points}})).height;
    std::vector<Line> lines;
    for (int i = 0; i < 8; ++i)
    {
        lines.push_back({"quite a long name of a contestant", points});
    }
    const Drawing drawing = draw(plot_of(lines));
    EXPECT_GT(drawing.height, low + 60.0);
    const std::vector<double> frame =
        numbers_behind(drawing.body, "<rect class=\"frame\" x=\"74.0\" y=\"");
    ASSERT_EQ(frame.size(), 1U);
    for (const double y : numbers_behind(drawing.body, "<g transform=\"translate(74.0 "))
    {
        EXPECT_LT(y + 6.0, frame[0]);
    }
}

TEST(LinePlot, any_name_is_text)
{
    const std::string hostile = "</svg><script>\"'&";
    const LinePlot plot{hostile, {hostile, true}, {hostile, true}, {{hostile, {{1, 1, hostile}}}}};
    const auto read = tactus::test::read_markup(to_svg_element(draw(plot)));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->count("script"), 0U);
    EXPECT_TRUE(read->has_text(hostile));
}

TEST(LinePlot, is_sound_with_nothing_in_it)
{
    for (const bool is_logarithmic : {false, true})
    {
        EXPECT_FALSE(body_of(plot_of({}, is_logarithmic)).empty());
        EXPECT_FALSE(body_of(plot_of({{"a", {}}}, is_logarithmic)).empty());
        EXPECT_FALSE(body_of(plot_of({{"a", {{0.0, 0.0, ""}}}}, is_logarithmic)).empty());
    }
}

TEST(LinePlot, the_same_plot_is_the_same_bytes)
{
    const LinePlot plot = plot_of({{"a", {{1.0, 1.0, "K"}, {2.0, 3.0, ""}}}});
    EXPECT_EQ(draw(plot).body, draw(plot).body);
}

} // namespace

} // namespace tactus::plot::test
