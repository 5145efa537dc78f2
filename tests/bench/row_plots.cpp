// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/row_plots.hpp"

#include "platform/plot/bar_plot.hpp"
#include "platform/plot/line_plot.hpp"
#include "platform/plot/stack_plot.hpp"
#include "tests/bench/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

namespace tactus::bench
{

namespace
{

constexpr const char* kFaces = "faces";
constexpr const char* kLaw = "law";

/// The value of a metric; nothing when there is no such row.
std::optional<double> value_of(const Rows& rows, const std::string& metric)
{
    const auto found = std::ranges::find(rows, metric, &Row::metric);
    return found == rows.end() ? std::nullopt : std::optional(found->value);
}

std::string author_of(const std::string& by)
{
    return by.empty() ? "Tactus" : by;
}

/// Of points by x: those below all before them.
void keep_front(std::vector<plot::Point>& points)
{
    double least = std::numeric_limits<double>::infinity();
    std::erase_if(points,
                  [&](const plot::Point& point)
                  {
                      const bool is_beaten = point.y >= least;
                      least = std::min(least, point.y);
                      return is_beaten;
                  });
}

/// The Pareto front of the settings that have both metrics, by x.
plot::Line front_of(const RowGroup& author, const char* x, const char* y)
{
    plot::Line line{author_of(author.key), {}};
    for (const auto& [setting, rows] : grouped_by(author.rows, &Row::setting))
    {
        const std::optional<double> at = value_of(rows, x);
        const std::optional<double> value = value_of(rows, y);
        if (at && value)
        {
            line.points.push_back({*at, *value, setting});
        }
    }
    std::ranges::stable_sort(line.points, [](const plot::Point& a, const plot::Point& b)
                             { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
    keep_front(line.points);
    return line;
}

bool is_count(const std::string& unit)
{
    return unit.empty() || unit == "count";
}

/// The rows that have this text there.
Rows group_of(const Rows& rows, std::string Row::*member, const std::string& text)
{
    Rows some;
    std::ranges::copy_if(rows, std::back_inserter(some),
                         [&](const Row& row) { return row.*member == text; });
    return some;
}

/// How many faces each case has.
std::map<std::string, double> faces_of(const Rows& rows)
{
    std::map<std::string, double> faces;
    for (const Row& row : rows)
    {
        if (row.metric == kFaces)
        {
            faces.emplace(row.test_case, row.value);
        }
    }
    return faces;
}

/// A line for each author and metric over the faces; `rows` are of one unit.
std::vector<plot::Line> growth_lines(const Rows& rows, const std::map<std::string, double>& faces)
{
    std::vector<plot::Line> lines;
    const std::vector<RowGroup> authors = grouped_by(rows, &Row::by);
    for (const auto& [by, of_author] : authors)
    {
        for (const auto& [metric, of_metric] : grouped_by(of_author, &Row::metric))
        {
            const bool is_guide = metric == kLaw;
            const bool is_shared = authors.size() > 1 && !is_guide;
            plot::Line line{metric + (is_shared ? ", " + author_of(by) : ""), {}, is_guide};
            for (const Row& row : of_metric)
            {
                const auto at = faces.find(row.test_case);
                if (at != faces.end() && metric != kFaces)
                {
                    line.points.push_back({at->second, row.value, row.setting});
                }
            }
            std::ranges::stable_sort(line.points, {}, &plot::Point::x);
            if (line.points.size() > 1)
            {
                lines.push_back(std::move(line));
            }
        }
    }
    return lines;
}

} // namespace

std::vector<plot::Drawing> error_time_plots(const Rows& rows)
{
    struct Figure
    {
        const char* metric;
        const char* title;
        const char* label;
    };
    constexpr std::array<Figure, 2> kFigures{
        {{"p99", "{}: time", "p99, us"}, {"memory", "{}: memory", "memory, MB"}}};
    std::vector<plot::Drawing> drawings;
    for (const auto& [name, of_case] : grouped_by(rows, &Row::test_case))
    {
        const Rows of_motion = group_of(of_case, &Row::part, "");
        const char* error = value_of(of_motion, "error p99") ? "error p99" : "error max";
        for (const Figure& figure : kFigures)
        {
            plot::LinePlot plot{fmt::format(fmt::runtime(figure.title), name),
                                {fmt::format("{}, shares of the diagonal", error), true},
                                {figure.label, true},
                                {}};
            for (const RowGroup& author : grouped_by(of_motion, &Row::by))
            {
                plot::Line line = front_of(author, error, figure.metric);
                if (!line.points.empty())
                {
                    plot.lines.push_back(std::move(line));
                }
            }
            if (!plot.lines.empty())
            {
                drawings.push_back(draw(plot));
            }
        }
    }
    return drawings;
}

std::vector<plot::Drawing> growth_plots(const Rows& rows)
{
    std::vector<plot::Drawing> drawings;
    for (const auto& [part, of_part] : grouped_by(rows, &Row::part))
    {
        for (const auto& [unit, of_unit] : grouped_by(of_part, &Row::unit))
        {
            plot::LinePlot plot{part, {kFaces, true}, {is_count(unit) ? "count" : unit, true}, {}};
            plot.lines = growth_lines(of_unit, faces_of(of_part));
            if (!plot.lines.empty())
            {
                drawings.push_back(draw(plot));
            }
        }
    }
    return drawings;
}

std::vector<plot::Drawing> skip_plots(const Rows& rows)
{
    std::vector<plot::Drawing> drawings;
    for (const auto& [name, of_case] : grouped_by(rows, &Row::test_case))
    {
        plot::BarPlot plot{name, "p99", {}};
        for (const auto& [setting, of_setting] : grouped_by(of_case, &Row::setting))
        {
            plot::BarGroup group{setting, {}};
            for (const Row& row : of_setting)
            {
                if (row.metric == "p99")
                {
                    const std::string of_part = row.part.empty() ? "" : row.part + ", ";
                    group.bars.push_back({of_part + author_of(row.by), row.value});
                    plot.x_label = "p99, " + row.unit;
                }
            }
            if (!group.bars.empty())
            {
                plot.groups.push_back(std::move(group));
            }
        }
        if (!plot.groups.empty())
        {
            drawings.push_back(draw(plot));
        }
    }
    return drawings;
}

std::vector<plot::Drawing> series_plots(const std::vector<StageSeries>& series)
{
    constexpr std::array<const char*, kSeriesStages> kNames{"T_L load", "T_R refine", "T_B refit",
                                                            "T_Q query"};
    std::vector<plot::Drawing> drawings;
    for (const StageSeries& one : series)
    {
        plot::StackPlot plot{one.test_case, "frame", "us", one.frames, {}};
        for (std::size_t stage = 0; stage < kSeriesStages; ++stage)
        {
            plot.layers.push_back({kNames.at(stage), one.us.at(stage)});
        }
        drawings.push_back(draw(plot));
    }
    return drawings;
}

} // namespace tactus::bench
