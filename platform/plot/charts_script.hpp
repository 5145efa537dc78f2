// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string_view>

namespace tactus::plot
{

/// Script that draws a page's charts with the chart library: platform/plot/charts.js.
[[nodiscard]] std::string_view charts_script() noexcept;

} // namespace tactus::plot
