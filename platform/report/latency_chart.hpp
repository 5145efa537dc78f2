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

/// 0.1 us to 100 s, `per_decade` of them.
[[nodiscard]] std::vector<double> edges_us(int per_decade);

/// Counts between neighbouring edges; what is below the first counts in the first bin.
[[nodiscard]] std::vector<double> counts_between(const LatencyHistogram& histogram,
                                                 const std::vector<double>& edges);

/// Histograms of one chart, with the names of their lines.
using NamedHistograms = std::vector<std::pair<std::string, const LatencyHistogram*>>;

/// Counts of what `what` names over microseconds, as far as there are any, and with the period,
/// which is marked.
[[nodiscard]] plot::Chart latency_chart(const std::string& title, const std::string& what,
                                        const NamedHistograms& histograms, Duration period);

} // namespace tactus::hrtc
