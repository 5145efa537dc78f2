// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>
#include <string_view>

namespace tactus::plot
{

/// Escapes any bytes as text of HTML or SVG, also for attributes. Bytes that are no character of
/// XML, control characters and broken UTF-8 become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// Script that draws a page's charts with the chart library: platform/plot/charts.js.
[[nodiscard]] std::string_view charts_script() noexcept;

} // namespace tactus::plot
