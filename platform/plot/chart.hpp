// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::plot
{

/// Emphasis of a mark; pages give each its colour.
enum class MarkKind : std::uint8_t
{
    plain,
    warning,
    fault,
};

/// A vertical line. Marks of one name are listed below the chart once, with their count.
struct Mark
{
    double x{0.0};
    std::string name;
    MarkKind kind{MarkKind::plain};
};

/// One line of a chart.
struct Line
{
    std::string name;
    /// One value for each x of the chart; a value that is not finite leaves a gap.
    std::vector<double> y;
};

/// Lines over one axis. A reader can zoom in and read values off it.
struct Chart
{
    enum class Kind : std::uint8_t
    {
        series,    ///< Lines over time. The series of a page are zoomed together.
        histogram, ///< Steps from x[i] to x[i + 1]; both axes logarithmic, all x positive.
    };

    std::string title;
    std::string x_label; ///< Label with its unit.
    std::string y_label; ///< Label with its unit.
    Kind kind{Kind::series};
    std::vector<double> x; ///< Ascending.
    std::vector<Line> lines;
    std::vector<Mark> marks;
};

/// The library that draws the charts of a page, inlined into it: Debian's libjs-dygraphs.
struct ChartLibrary
{
    std::string script;
    std::string style;
    /// Reason why there is no library, shown on the page; empty: there is one.
    std::string missing;

    /// Reads dygraphs/dygraph.min.js and .css below `folder`. A file that can't be read, or that
    /// would end its element, sets `missing`.
    [[nodiscard]] static ChartLibrary read(const std::filesystem::path& folder);
    /// Reads the library from the package's folder.
    [[nodiscard]] static ChartLibrary packaged();
};

} // namespace tactus::plot
