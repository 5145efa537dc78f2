// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::plot
{

/// A histogram's outline.
struct Steps
{
    std::string name;           ///< For the legend.
    std::vector<double> edges;  ///< Ascending, positive; one more than counts.
    std::vector<double> counts; ///< Not negative.
};

/// A vertical line that the eye should compare with.
struct Mark
{
    double x{0.0};
    std::string name;
};

/// One panel: counts over x, both axes logarithmic.
struct Panel
{
    std::string title;
    std::string x_label; ///< With its unit.
    std::string y_label;
    std::vector<Steps> steps;
    std::vector<Mark> marks; ///< Drawn where they are within the axis.
};

/// Each panel's drawing, all over the same range of x: whole decades that hold every count.
[[nodiscard]] std::vector<Drawing> draw(std::span<const Panel> panels);

/// The same as one SVG file, the panels one below the other.
[[nodiscard]] std::string make_svg(std::span<const Panel> panels);

} // namespace tactus::plot
