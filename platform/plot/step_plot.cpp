// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/step_plot.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::plot
{

namespace
{

/// Where a count of zero is drawn: counts of one stand out from the axis.
constexpr double kLeastCount = 0.6;

/// A whole number of decades.
Axis decades(double least, double most)
{
    // Edges are powers of ten up to rounding.
    const double first = std::floor(std::log10(least) + 1e-9);
    const double last = std::ceil(std::log10(most) - 1e-9);
    return Axis::exactly(std::pow(10.0, first), std::pow(10.0, std::max(last, first + 1.0)));
}

Axis x_axis_of(std::span<const Panel> panels)
{
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (const Panel& panel : panels)
    {
        for (const Steps& steps : panel.steps)
        {
            for (std::size_t i = 0; i < steps.counts.size(); ++i)
            {
                if (steps.counts[i] > 0.0)
                {
                    least = std::min(least, steps.edges[i]);
                    most = std::max(most, steps.edges[i + 1]);
                }
            }
        }
    }
    return most == 0.0 ? decades(1.0, 10.0) : decades(least, most);
}

Axis y_axis_of(const Panel& panel)
{
    double most = 10.0;
    for (const Steps& steps : panel.steps)
    {
        for (const double count : steps.counts)
        {
            most = std::max(most, count);
        }
    }
    return Axis::exactly(kLeastCount, std::pow(10.0, std::ceil(std::log10(most) - 1e-9)));
}

std::string line_of(const Mark& mark, const Chart& chart)
{
    if (!chart.x_axis().holds(mark.x))
    {
        return {};
    }
    const double x = chart.x_of(mark.x);
    const bool is_left = x + 4.0 + width_of(mark.name) > chart.right();
    return fmt::format("<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" "
                       "y2=\"{2:.1f}\"/>\n<text x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"{5}\">"
                       "{6}</text>\n",
                       x, chart.top(), chart.bottom(), is_left ? x - 4.0 : x + 4.0,
                       chart.top() + 14.0, is_left ? "end" : "start", escaped(mark.name));
}

std::string line_of(const Steps& steps, const Look& look, const Chart& chart)
{
    const auto y_of = [&](double count) { return chart.y_of(std::max(count, kLeastCount)); };
    std::string path;
    double last = 0.0;
    for (std::size_t i = 0; i < steps.counts.size(); ++i)
    {
        const double count = steps.counts[i];
        if (count > 0.0 || last > 0.0)
        {
            const double x = chart.x_of(steps.edges[i]);
            path += last > 0.0 ? fmt::format("V{:.1f}", y_of(count))
                               : fmt::format("M{:.1f} {:.1f}V{:.1f}", x, y_of(0.0), y_of(count));
            path += count > 0.0 ? fmt::format("H{:.1f}", chart.x_of(steps.edges[i + 1])) : "";
        }
        last = count;
    }
    path += last > 0.0 ? fmt::format("V{:.1f}", y_of(0.0)) : "";
    return fmt::format("<path class=\"line\" {} d=\"{}\"/>\n", look.stroke(), path);
}

Drawing draw_one(const Panel& panel, const Axis& x)
{
    std::vector<LegendEntry> legend;
    for (std::size_t i = 0; i < panel.steps.size(); ++i)
    {
        legend.push_back(
            {panel.steps[i].name,
             fmt::format("<path class=\"line\" {} d=\"M0 0h26\"/>", Look(i).stroke())});
    }
    const Chart chart({panel.title, panel.x_label, panel.y_label}, x, y_axis_of(panel),
                      std::move(legend));
    std::string data;
    for (const Mark& mark : panel.marks)
    {
        data += line_of(mark, chart);
    }
    for (std::size_t i = 0; i < panel.steps.size(); ++i)
    {
        data += line_of(panel.steps[i], Look(i), chart);
    }
    return chart.around(data);
}

} // namespace

std::vector<Drawing> draw(std::span<const Panel> panels)
{
    const Axis x = x_axis_of(panels);
    std::vector<Drawing> drawings;
    for (const Panel& panel : panels)
    {
        drawings.push_back(draw_one(panel, x));
    }
    return drawings;
}

std::string make_svg(std::span<const Panel> panels)
{
    return to_svg_file(stacked(draw(panels)));
}

} // namespace tactus::plot
