// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"

#include <string>
#include <vector>

namespace tactus::plot
{

struct Layer
{
    std::string name;           ///< For the legend.
    std::vector<double> values; ///< Not negative; as many as there are places.
};

/// Areas one on the other, the first layer lowest: parts of a sum over time.
struct StackPlot
{
    std::string title;
    std::string x_label; ///< With its unit.
    std::string y_label;
    std::vector<double> places; ///< Ascending, not negative.
    std::vector<Layer> layers;
};

/// Values that are not finite count as 0.
[[nodiscard]] Drawing draw(const StackPlot& plot);

} // namespace tactus::plot
