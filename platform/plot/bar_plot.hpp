// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"

#include <string>
#include <vector>

namespace tactus::plot
{

struct Bar
{
    std::string name;
    double value{0.0}; ///< Not negative; one that is not finite is named and has no bar.
};

struct BarGroup
{
    std::string name; ///< Above its bars; empty: nothing is.
    std::vector<Bar> bars;
};

/// Horizontal bars from zero, named at the left, their values at the right. Bars of one name have
/// one colour in all groups.
struct BarPlot
{
    std::string title;
    std::string x_label; ///< With its unit.
    std::vector<BarGroup> groups;
};

[[nodiscard]] Drawing draw(const BarPlot& plot);

} // namespace tactus::plot
