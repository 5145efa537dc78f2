// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/latency_chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::hrtc
{

std::vector<double> edges_us(int per_decade)
{
    constexpr int kDecades = 9;
    std::vector<double> edges;
    for (int i = 0; i <= kDecades * per_decade; ++i)
    {
        edges.push_back(0.1 * std::pow(10.0, static_cast<double>(i) / per_decade));
    }
    return edges;
}

std::vector<double> counts_between(const LatencyHistogram& histogram,
                                   const std::vector<double>& edges)
{
    std::vector<double> counts;
    std::uint64_t before = 0;
    for (std::size_t i = 1; i < edges.size(); ++i)
    {
        const auto upper_ns = static_cast<std::int64_t>(std::llround(edges[i] * 1e3));
        const std::uint64_t up_to = histogram.count_to({upper_ns});
        counts.push_back(static_cast<double>(up_to - before));
        before = up_to;
    }
    return counts;
}

plot::Chart latency_chart(const std::string& title, const std::string& what,
                          const NamedHistograms& histograms, Duration period)
{
    constexpr int kPerDecade = 20;
    const std::vector<double> edges = edges_us(kPerDecade);
    plot::Chart chart{.title = title,
                      .x_label = "us",
                      .y_label = what,
                      .kind = plot::Chart::Kind::histogram,
                      .x = {},
                      .lines = {},
                      .marks = {{to_us(period), "period", plot::MarkKind::plain}}};
    std::size_t first = 0; // First bin of the chart, at most that of the period.
    while (first + 2 < edges.size() && edges[first + 1] < to_us(period))
    {
        ++first;
    }
    std::size_t last = first; // Last bin of the chart, at least that of the period.
    for (const auto& [name, histogram] : histograms)
    {
        std::vector<double> counts = counts_between(*histogram, edges);
        for (std::size_t bin = 0; bin < counts.size(); ++bin)
        {
            if (counts[bin] > 0.0)
            {
                first = std::min(first, bin);
                last = std::max(last, bin);
            }
            else
            {
                counts[bin] = std::numeric_limits<double>::quiet_NaN(); // Zero has no logarithm.
            }
        }
        chart.lines.push_back({name, std::move(counts)});
    }
    const auto from = static_cast<std::ptrdiff_t>(first);
    const auto end = static_cast<std::ptrdiff_t>(last + 1);
    chart.x.assign(edges.begin() + from, edges.begin() + end + 1);
    for (plot::Line& line : chart.lines)
    {
        line.y = {line.y.begin() + from, line.y.begin() + end};
        line.y.push_back(std::numeric_limits<double>::quiet_NaN()); // End of the last bin.
    }
    return chart;
}

} // namespace tactus::hrtc
