// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/latency_histogram.hpp"
#include "platform/plot/step_plot.hpp"

#include <string>
#include <vector>

namespace tactus::hrtc
{

/// 0.1 us to 100 s, `per_decade` of them.
[[nodiscard]] std::vector<double> edges_us(int per_decade);

/// Counts between neighbouring edges; what is below the first counts in the first bin.
[[nodiscard]] std::vector<double> counts_between(const LatencyHistogram& histogram,
                                                 const std::vector<double>& edges);

/// A histogram as a plot has it, in microseconds.
[[nodiscard]] plot::Steps steps_of(const std::string& name, const LatencyHistogram& histogram);

} // namespace tactus::hrtc
