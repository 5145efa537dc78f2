// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

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
    std::vector<Steps> steps; ///< At most kStepsMax.
    std::vector<Mark> marks;  ///< Drawn where they are within the axis.

    static constexpr std::size_t kStepsMax = 4;
};

/// An SVG image of the panels, one below the other, all over the same range of x, whole decades
/// that hold every count. It needs nothing but itself, follows the reader's light or dark scheme,
/// and tells lines apart by dash and by colours close to Okabe and Ito's for the colour-blind.
[[nodiscard]] std::string make_svg(std::span<const Panel> panels);

} // namespace tactus::plot
