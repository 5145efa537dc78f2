// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/step_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::plot
{

namespace
{

// In the image's units, pixels at its natural size.
constexpr double kWidth = 760.0;
constexpr double kPanelHeight = 270.0;
constexpr double kLeft = 78.0;
constexpr double kRight = 34.0;
constexpr double kTop = 52.0;
constexpr double kBottom = 50.0;
constexpr double kPlotWidth = kWidth - kLeft - kRight;
constexpr double kPlotHeight = kPanelHeight - kTop - kBottom;
/// Where a count of zero is drawn: counts of one stand out from the axis.
constexpr double kLeastCount = 0.6;

constexpr const char* kStyle =
    "  :root { color-scheme: light dark; --ink: #222; --grid: #d8d8d8; --paper: #fff; }\n"
    "  @media (prefers-color-scheme: dark) {\n"
    "    :root { --ink: #e8e8e8; --grid: #444; --paper: #181818; }\n"
    "  }\n"
    "  .paper { fill: var(--paper); }\n"
    "  text { font: 13px sans-serif; fill: var(--ink); }\n"
    "  .title { font-weight: bold; font-size: 14px; }\n"
    "  .grid { stroke: var(--grid); stroke-width: 1; }\n"
    "  .frame { fill: none; stroke: var(--ink); stroke-width: 1; }\n"
    "  .mark { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 2 3; }\n"
    "  .line { fill: none; stroke-width: 1.8; }\n";

struct LineStyle
{
    const char* colour;
    const char* dash;
};
constexpr std::array<LineStyle, Panel::kStepsMax> kLines{
    {{"#1f8fd1", "none"}, {"#d55e00", "6 3"}, {"#009e73", "2 2"}, {"#cc79a7", "8 3 2 3"}}};

/// A whole number of decades.
struct Axis
{
    int first;
    int last;

    [[nodiscard]] double share(double value) const
    {
        return (std::log10(value) - first) / (last - first);
    }
};

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        switch (c)
        {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

/// "1 000", "0.01".
std::string decade_text(int decade)
{
    if (decade < 0)
    {
        return fmt::format("{:.{}f}", std::pow(10.0, decade), -decade);
    }
    std::string digits = "1" + std::string(static_cast<std::size_t>(decade), '0');
    for (std::ptrdiff_t at = std::ssize(digits) - 3; at > 0; at -= 3)
    {
        digits.insert(static_cast<std::size_t>(at), "\u2009"); // A thin space.
    }
    return digits;
}

Axis x_axis_of(std::span<const Panel> panels)
{
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (const Panel& panel : panels)
    {
        for (const Steps& steps : panel.steps)
        {
            for (std::size_t i = 0; i < steps.counts.size(); ++i)
            {
                if (steps.counts[i] > 0.0)
                {
                    least = std::min(least, steps.edges[i]);
                    most = std::max(most, steps.edges[i + 1]);
                }
            }
        }
    }
    if (most == 0.0) // Nothing was counted.
    {
        return {0, 1};
    }
    // Edges are powers of ten up to rounding.
    const int first = static_cast<int>(std::floor(std::log10(least) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(most) - 1e-9));
    return {first, std::max(last, first + 1)};
}

Axis y_axis_of(const Panel& panel)
{
    double most = 1.0;
    for (const Steps& steps : panel.steps)
    {
        for (const double count : steps.counts)
        {
            most = std::max(most, count);
        }
    }
    return {0, std::max(static_cast<int>(std::ceil(std::log10(most))), 1)};
}

/// One panel with its own origin; `y_of` maps counts to the image.
class PanelWriter
{
public:
    PanelWriter(const Panel& panel, Axis x, double top)
        : panel_(panel), x_(x), y_(y_axis_of(panel)), top_(top + kTop)
    {
    }

    [[nodiscard]] std::string write() const
    {
        std::string svg = fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                                      kLeft, top_ - 30.0, escaped(panel_.title));
        svg += axes() + legend();
        for (const Mark& mark : panel_.marks)
        {
            svg += line_of(mark);
        }
        for (std::size_t i = 0; i < panel_.steps.size(); ++i)
        {
            svg += line_of(panel_.steps[i], kLines.at(i));
        }
        return svg;
    }

private:
    [[nodiscard]] double x_of(double value) const
    {
        return kLeft + kPlotWidth * std::clamp(x_.share(value), 0.0, 1.0);
    }
    [[nodiscard]] double y_of(double count) const
    {
        const double low = std::log10(kLeastCount);
        const double share = (std::log10(std::max(count, kLeastCount)) - low) / (y_.last - low);
        return top_ + kPlotHeight * (1.0 - share);
    }

    [[nodiscard]] std::string axes() const
    {
        const double bottom = top_ + kPlotHeight;
        std::string svg;
        for (int decade = x_.first; decade <= x_.last; ++decade)
        {
            const double x = kLeft + kPlotWidth * (decade - x_.first) / (x_.last - x_.first);
            svg += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" "
                               "y2=\"{2:.1f}\"/>\n"
                               "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4}"
                               "</text>\n",
                               x, top_, bottom, bottom + 17.0, decade_text(decade));
        }
        const int every = (y_.last + 4) / 5;
        for (int decade = 0; decade <= y_.last; decade += every)
        {
            const double y = y_of(std::pow(10.0, decade));
            svg += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" "
                               "y2=\"{2:.1f}\"/>\n",
                               kLeft, kWidth - kRight, y);
            svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                               kLeft - 6.0, y + 4.5, decade_text(decade));
        }
        svg += fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                           "height=\"{:.1f}\"/>\n",
                           kLeft, top_, kPlotWidth, kPlotHeight);
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                           kLeft + kPlotWidth / 2.0, bottom + 36.0, escaped(panel_.x_label));
        svg += fmt::format("<text transform=\"translate(16 {:.1f}) rotate(-90)\" "
                           "text-anchor=\"middle\">{}</text>\n",
                           top_ + kPlotHeight / 2.0, escaped(panel_.y_label));
        return svg;
    }

    [[nodiscard]] std::string legend() const
    {
        constexpr double kEach = 170.0;
        std::string svg;
        for (std::size_t i = 0; i < panel_.steps.size(); ++i)
        {
            const double x = kLeft + kEach * static_cast<double>(i);
            svg += fmt::format("<path class=\"line\" stroke=\"{}\" stroke-dasharray=\"{}\" "
                               "d=\"M{:.1f} {:.1f}h26\"/>\n",
                               kLines.at(i).colour, kLines.at(i).dash, x, top_ - 13.0);
            svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 32.0, top_ - 9.0,
                               escaped(panel_.steps[i].name));
        }
        return svg;
    }

    [[nodiscard]] std::string line_of(const Mark& mark) const
    {
        const double share = x_.share(mark.x);
        if (!(share > 0.0 && share < 1.0))
        {
            return {};
        }
        const double x = x_of(mark.x);
        return fmt::format("<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" "
                           "y2=\"{2:.1f}\"/>\n<text x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
                           x, top_, top_ + kPlotHeight, x + 4.0, top_ + 14.0, escaped(mark.name));
    }

    [[nodiscard]] std::string line_of(const Steps& steps, const LineStyle& style) const
    {
        std::string path;
        double last = 0.0;
        for (std::size_t i = 0; i < steps.counts.size(); ++i)
        {
            const double count = steps.counts[i];
            if (count > 0.0 || last > 0.0)
            {
                const double x = x_of(steps.edges[i]);
                path += last > 0.0
                            ? fmt::format("V{:.1f}", y_of(count))
                            : fmt::format("M{:.1f} {:.1f}V{:.1f}", x, y_of(0.0), y_of(count));
                path += count > 0.0 ? fmt::format("H{:.1f}", x_of(steps.edges[i + 1])) : "";
            }
            last = count;
        }
        path += last > 0.0 ? fmt::format("V{:.1f}", y_of(0.0)) : "";
        return fmt::format(
            "<path class=\"line\" stroke=\"{}\" stroke-dasharray=\"{}\" d=\"{}\"/>\n", style.colour,
            style.dash, path);
    }

    const Panel& panel_;
    Axis x_;
    Axis y_;
    double top_;
};

} // namespace

std::string make_svg(std::span<const Panel> panels)
{
    const double height = kPanelHeight * static_cast<double>(panels.size());
    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
                                  "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>\n"
                                  "{2}</style>\n<rect class=\"paper\" width=\"100%\" "
                                  "height=\"100%\"/>\n",
                                  kWidth, height, kStyle);
    const Axis x = x_axis_of(panels);
    double top = 0.0;
    for (const Panel& panel : panels)
    {
        svg += PanelWriter(panel, x, top).write();
        top += kPanelHeight;
    }
    return svg + "</svg>\n";
}

} // namespace tactus::plot
