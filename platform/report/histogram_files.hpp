// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/run_statistics.hpp"
#include "platform/machine/latency_histogram.hpp"
#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus::hrtc
{

/// The percentiles as HdrHistogram prints them, in microseconds (.hgrm): its plotter and others
/// read them. Five lines for each half of what is left to 100 %.
[[nodiscard]] std::string hdr_text(const LatencyHistogram& histogram);

/// Writes one file for each of the report's times, named after it: frame.hgrm and so on. Returns
/// why one can't be written.
[[nodiscard]] std::optional<Refusal> write_histograms(const RunStatistics& statistics,
                                                      const std::string& folder);

} // namespace tactus::hrtc
