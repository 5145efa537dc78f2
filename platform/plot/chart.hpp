// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/axis.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::plot
{

/// In an image's units, pixels at its natural size. Every drawing is so wide; pages scale it.
inline constexpr double kDrawingWidth = 540.0;

/// What goes into an image: elements of SVG, from 0 to the width and the height.
struct Drawing
{
    std::string title; ///< For who can't see it.
    double height{0.0};
    std::string body;
};

/// How the style sheet of a drawing's classes names its colours; pages have the same.
[[nodiscard]] const char* drawing_colours();
/// The style sheet of a drawing's classes, without the colours.
[[nodiscard]] const char* drawing_style();
/// An SVG file of its own: it needs nothing but itself and follows the reader's light or dark
/// scheme.
[[nodiscard]] std::string to_svg_file(const Drawing& drawing);
/// An element for a page that has both style sheets; it is as wide as its box lets it be.
[[nodiscard]] std::string to_svg_element(const Drawing& drawing);

/// How the things of one name look: lines of a few are told apart by colour, close to Okabe and
/// Ito's for the colour-blind, and by dash.
class Look
{
public:
    explicit Look(std::size_t place) : place_(place) {}

    [[nodiscard]] const char* colour() const;
    /// Attributes of an element of the class "line".
    [[nodiscard]] std::string stroke() const;

private:
    std::size_t place_;
};

/// One name in a legend, and a sample of 26 by 0 about its origin.
struct LegendEntry
{
    std::string name;
    std::string sample;
};

/// What stands around the data of a plot of two axes: title, legend, grid, ticks and labels. The
/// legend is above the frame, in as many rows as it needs.
class Chart
{
public:
    struct Words
    {
        std::string title;
        std::string x_label; ///< With its unit.
        std::string y_label;
    };

    Chart(Words words, const Axis& x, const Axis& y, std::vector<LegendEntry> legend);

    [[nodiscard]] double x_of(double value) const;
    [[nodiscard]] double y_of(double value) const;
    [[nodiscard]] double left() const;
    [[nodiscard]] double right() const;
    [[nodiscard]] double top() const { return top_; }
    [[nodiscard]] double bottom() const;
    [[nodiscard]] const Axis& x_axis() const { return x_; }
    [[nodiscard]] const Axis& y_axis() const { return y_; }

    /// The data, in the chart's coordinates, with everything around them.
    [[nodiscard]] Drawing around(const std::string& data) const;

private:
    [[nodiscard]] std::string legend() const;
    [[nodiscard]] std::string grid() const;
    [[nodiscard]] std::string labels() const;

    Words words_;
    Axis x_;
    Axis y_;
    std::vector<LegendEntry> legend_;
    std::vector<double> legend_x_; ///< Where each entry starts,
    std::vector<double> legend_y_; ///< and its middle.
    double top_{0.0};              ///< Of the frame.
};

/// About how wide a text is, and how many characters fit; letters differ, so neither is exact.
[[nodiscard]] double width_of(const std::string& text);
[[nodiscard]] std::size_t characters_in(double width);

/// The drawings one below the other, as one.
[[nodiscard]] Drawing stacked(const std::vector<Drawing>& drawings);

} // namespace tactus::plot
