// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"

#include <string>
#include <vector>

namespace tactus::plot
{

struct Point
{
    double x{0.0};
    double y{0.0};
    std::string label; ///< Beside the first and the last of a line; the others tell it when pointed
                       ///< at.
};

/// Points joined in their order, each with a marker.
struct Line
{
    std::string name; ///< For the legend.
    std::vector<Point> points;
    bool is_guide{false}; ///< What the others are to be held against: dotted, without markers.
};

struct Quantity
{
    std::string label; ///< With its unit.
    bool is_logarithmic{false};
};

struct LinePlot
{
    std::string title;
    Quantity x;
    Quantity y;
    std::vector<Line> lines;
};

/// Points that an axis can't show, such as what is not a number, are left out. Zero on a
/// logarithmic axis has a marked column of its own.
[[nodiscard]] Drawing draw(const LinePlot& plot);

} // namespace tactus::plot
