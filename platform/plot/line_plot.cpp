// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/line_plot.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tactus::plot
{

namespace
{

constexpr const char* kGuide = "stroke=\"var(--ink)\" stroke-dasharray=\"1.5 4\"";

/// What is taken of the image.
struct Box
{
    double left, right, top, bottom;

    [[nodiscard]] bool meets(const Box& other) const
    {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};

/// Puts texts beside points where nothing else is, or not at all.
class Labels
{
public:
    explicit Labels(const Chart& chart) : chart_(chart) {}

    /// A line's points and what joins them.
    void keep_free(const std::vector<Point>& points)
    {
        constexpr double kMarker = 5.0;
        constexpr double kJoint = 2.0; ///< About a line, and half as far as its boxes are apart.
        for (std::size_t i = 0; i < points.size(); ++i)
        {
            const double x = chart_.x_of(points[i].x);
            const double y = chart_.y_of(points[i].y);
            take(x, y, kMarker);
            const Point& next = points[std::min(i + 1, points.size() - 1)];
            const double along_x = chart_.x_of(next.x) - x;
            const double along_y = chart_.y_of(next.y) - y;
            const double steps = std::ceil(std::hypot(along_x, along_y) / (2.0 * kJoint));
            for (double step = 1.0; step < steps; step += 1.0)
            {
                take(x + along_x * step / steps, y + along_y * step / steps, kJoint);
            }
        }
    }

    [[nodiscard]] std::string place(const Point& point)
    {
        constexpr double kNoteLetter = 6.6; // At the size of notes.
        constexpr double kHigh = 12.0;
        const double x = chart_.x_of(point.x);
        const double y = chart_.y_of(point.y);
        const double width = kNoteLetter * static_cast<double>(characters_of(point.label));
        std::vector<Box> places;
        for (const double away : {0.0, 12.0, 24.0}) // Beside the point, then further off.
        {
            const double above = y - 15.0 - away;
            const double below = y + 3.0 + away;
            for (const double left : {x + 7.0, x - 7.0 - width, x - width / 2.0})
            {
                places.push_back({left, left + width, above, above + kHigh});
                places.push_back({left, left + width, below, below + kHigh});
            }
        }
        const auto found =
            std::ranges::find_if(places, [this](const Box& box) { return fits(box); });
        if (point.label.empty() || found == places.end())
        {
            return {};
        }
        taken_.push_back(*found);
        return fmt::format("<text class=\"note\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                           found->left, found->bottom - 2.0, escaped(point.label));
    }

private:
    void take(double x, double y, double half)
    {
        taken_.push_back({x - half, x + half, y - half, y + half});
    }

    [[nodiscard]] bool fits(const Box& box) const
    {
        return box.left >= chart_.left() && box.right <= chart_.right() &&
               box.top >= chart_.top() && box.bottom <= chart_.bottom() &&
               std::ranges::none_of(taken_, [&](const Box& other) { return box.meets(other); });
    }

    const Chart& chart_;
    std::vector<Box> taken_;
};

Axis axis_of(const LinePlot& plot, const Quantity& quantity, double Point::*value)
{
    std::vector<double> values;
    for (const Line& line : plot.lines)
    {
        for (const Point& point : line.points)
        {
            values.push_back(point.*value);
        }
    }
    return Axis::fitted(values, quantity.is_logarithmic);
}

std::string stroke_of(const Line& line, const Look& look)
{
    return line.is_guide ? kGuide : look.stroke();
}

std::string told_of(const Line& line, const Point& point)
{
    return fmt::format("{}{}{}: {}, {}", line.name, point.label.empty() ? "" : ", ", point.label,
                       number_text(point.x), number_text(point.y));
}

/// The points that there is a place for.
std::vector<Point> shown(const Line& line, const Chart& chart)
{
    std::vector<Point> points;
    std::ranges::copy_if(line.points, std::back_inserter(points),
                         [&](const Point& point) {
                             return chart.x_axis().can_show(point.x) &&
                                    chart.y_axis().can_show(point.y);
                         });
    return points;
}

std::string path_of(const std::vector<Point>& points, const std::string& stroke, const Chart& chart)
{
    if (points.size() < 2)
    {
        return {};
    }
    std::string path;
    for (const Point& point : points)
    {
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", chart.x_of(point.x),
                            chart.y_of(point.y));
    }
    return fmt::format("<path class=\"line\" {} d=\"{}\"/>\n", stroke, path);
}

std::vector<LegendEntry> legend_of(const LinePlot& plot)
{
    std::vector<LegendEntry> legend;
    for (std::size_t i = 0; i < plot.lines.size(); ++i)
    {
        const Line& line = plot.lines[i];
        legend.push_back({line.name, fmt::format("<path class=\"line\" {} d=\"M0 0h26\"/>{}",
                                                 stroke_of(line, Look(i)),
                                                 line.is_guide ? "" : Look(i).marker(13, 0, ""))});
    }
    return legend;
}

} // namespace

Drawing draw(const LinePlot& plot)
{
    const Chart chart({plot.title, plot.x.label, plot.y.label}, axis_of(plot, plot.x, &Point::x),
                      axis_of(plot, plot.y, &Point::y), legend_of(plot));
    std::string lines;
    std::string markers;
    Labels labels(chart);
    for (std::size_t i = 0; i < plot.lines.size(); ++i)
    {
        const Line& line = plot.lines[i];
        const std::vector<Point> points = shown(line, chart);
        lines += path_of(points, stroke_of(line, Look(i)), chart);
        for (const Point& point : points)
        {
            markers += line.is_guide ? ""
                                     : Look(i).marker(chart.x_of(point.x), chart.y_of(point.y),
                                                      told_of(line, point));
        }
        labels.keep_free(points);
    }
    std::string texts;
    for (const Line& line : plot.lines)
    {
        const std::vector<Point> points = shown(line, chart);
        texts += points.empty() ? "" : labels.place(points.front());
        texts += points.size() < 2 ? "" : labels.place(points.back());
    }
    return chart.around(lines + markers + texts);
}

} // namespace tactus::plot
