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

/// Percentiles of the histogram in microseconds, as text in the format of HdrHistogram (.hgrm) for
/// its plotter and other readers. Each halving of the share above a percentile has five lines.
[[nodiscard]] std::string hdr_text(const LatencyHistogram& histogram);

/// Writes one file for each of the report's times, named after it, such as frame.hgrm. Returns the
/// refusal of the first file that can't be written.
[[nodiscard]] std::optional<Refusal> write_histograms(const RunStatistics& statistics,
                                                      const std::string& folder);

} // namespace tactus::hrtc
