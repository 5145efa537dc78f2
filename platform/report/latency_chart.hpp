// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/latency_histogram.hpp"
#include "platform/plot/chart.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

/// Edges of the bins in microseconds, from 0.1 us to 100 s, `per_decade` in each decade.
[[nodiscard]] std::vector<double> edges_us(int per_decade);

/// Counts between neighbouring edges. Values below the first edge count in the first bin.
[[nodiscard]] std::vector<double> counts_between(const LatencyHistogram& histogram,
                                                 const std::vector<double>& edges);

/// Histograms of one chart, with the names of their lines.
using NamedHistograms = std::vector<std::pair<std::string, const LatencyHistogram*>>;

/// Chart of the counts of `what` over microseconds, from the first bin with a count to the last.
/// The chart always includes the period and marks it.
[[nodiscard]] plot::Chart latency_chart(const std::string& title, const std::string& what,
                                        const NamedHistograms& histograms, Duration period);

} // namespace tactus::hrtc
