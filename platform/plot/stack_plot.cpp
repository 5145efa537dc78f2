// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/stack_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

namespace tactus::plot
{

namespace
{

using Heights = std::vector<double>;

/// The edges between the layers: the first is zero, the last the sum of all.
std::vector<Heights> edges_of(const StackPlot& plot)
{
    std::vector<Heights> edges{Heights(plot.places.size(), 0.0)};
    for (const Layer& layer : plot.layers)
    {
        Heights edge = edges.back();
        for (std::size_t i = 0; i < std::min(edge.size(), layer.values.size()); ++i)
        {
            edge[i] += std::isfinite(layer.values[i]) ? layer.values[i] : 0.0;
        }
        edges.push_back(std::move(edge));
    }
    return edges;
}

/// Points of a path along an edge: "x y", the next one behind an L.
std::string along(const std::vector<double>& places, const Heights& edge, const Chart& chart,
                  bool is_backward)
{
    std::string path;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        const std::size_t at = is_backward ? places.size() - 1 - i : i;
        path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "" : "L", chart.x_of(places[at]),
                            chart.y_of(edge[at]));
    }
    return path;
}

} // namespace

Drawing draw(const StackPlot& plot)
{
    const std::vector<Heights> edges = edges_of(plot);
    std::vector<LegendEntry> legend;
    for (std::size_t i = 0; i < plot.layers.size(); ++i)
    {
        legend.push_back({plot.layers[i].name,
                          fmt::format("<path class=\"area\" fill=\"{}\" d=\"M0 0h26v6h-26z\"/>"
                                      "<path class=\"edge\" {} d=\"M0 0h26\"/>",
                                      Look(i).colour(), Look(i).stroke())});
    }
    const Chart chart({plot.title, plot.x_label, plot.y_label}, Axis::fitted(plot.places, false),
                      Axis::fitted(edges.back(), false), std::move(legend));
    std::string areas;
    std::string lines;
    for (std::size_t i = 0; i < plot.layers.size() && !plot.places.empty(); ++i)
    {
        const std::string upper = along(plot.places, edges[i + 1], chart, false);
        areas += fmt::format("<path class=\"area\" fill=\"{}\" d=\"M{}L{}z\"/>\n", Look(i).colour(),
                             upper, along(plot.places, edges[i], chart, true));
        lines += fmt::format("<path class=\"edge\" {} d=\"M{}\"/>\n", Look(i).stroke(), upper);
    }
    return chart.around(areas + lines);
}

} // namespace tactus::plot
