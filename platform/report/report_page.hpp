// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/run_statistics.hpp"
#include "platform/plot/chart.hpp"
#include "platform/plot/relief.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace tactus::hrtc
{

/// A run's report as an HTML page: what it comes to, every figure of the report, and charts of
/// `statistics`, those that the report is made from: force, bounds and stage times over the run,
/// and histograms of the times.
/// `relief` shows where the tools were; without it the page has no picture.
[[nodiscard]] std::string make_page(const nlohmann::ordered_json& report,
                                    const RunStatistics& statistics, plot::ChartLibrary library,
                                    const plot::Relief& relief = {});

} // namespace tactus::hrtc
