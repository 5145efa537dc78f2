// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/latency_plot.hpp"

#include <cmath>

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

plot::Steps steps_of(const std::string& name, const LatencyHistogram& histogram)
{
    constexpr int kPerDecade = 20;
    const std::vector<double> edges = edges_us(kPerDecade);
    return {name, edges, counts_between(histogram, edges)};
}

} // namespace tactus::hrtc
