// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/stage_series.hpp"

#include <vector>

namespace tactus::bench
{

/// What time an error costs: for each case a plot of "p99" over "error p99" or, without those,
/// "error max", a line for each author, a point for each setting.
[[nodiscard]] std::vector<plot::Drawing> error_time_plots(const Rows& rows);

/// How figures grow with the model: for each part and unit (us, or a count) a plot over the metric
/// "faces" of the same case, author and setting; the metric "law" is a guide.
[[nodiscard]] std::vector<plot::Drawing> growth_plots(const Rows& rows);

/// What skipping saves: for each case bars of "p99", a group for each setting.
[[nodiscard]] std::vector<plot::Drawing> skip_plots(const Rows& rows);

/// T_L, T_R, T_B and T_Q one on the other over the frames.
[[nodiscard]] std::vector<plot::Drawing> series_plots(const std::vector<StageSeries>& series);

} // namespace tactus::bench
