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

/// HTML page of a run's report, with the verdict, all figures and charts. `statistics` must be
/// those of the report. The charts show force, bounds and stage times over the run, and histograms
/// of the times. `relief` shows the paths of the tools; without it the page has no picture.
[[nodiscard]] std::string make_page(const nlohmann::ordered_json& report,
                                    const RunStatistics& statistics, plot::ChartLibrary library,
                                    const plot::Relief& relief = {});

} // namespace tactus::hrtc
