// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/chart.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tactus::plot
{

namespace
{

constexpr double kLeft = 74.0;
constexpr double kRight = 22.0;
constexpr double kPlotHeight = 190.0;
constexpr double kTitle = 20.0; ///< Its base line.
constexpr double kLegendTop = 40.0;
constexpr double kLegendRow = 20.0;
constexpr double kBelow = 50.0; ///< For the ticks' texts and the label.
constexpr double kLetter = 7.4; ///< About the mean width at the style's size.
constexpr double kSample = 32.0;

constexpr std::array kColours{"#1f8fd1", "#d55e00", "#009e73", "#cc79a7",
                              "#c98a00", "#7a5cc0", "#8a8a3c", "#7f8790"};
constexpr std::array kDashes{"none", "7 3", "2 2", "9 3 2 3", "12 3", "4 2 1 2 1 2"};

constexpr const char* kColourSheet = ":root { --ink: #222; --grid: #d8d8d8; --paper: #fff; }\n"
                                     "@media screen { :root { color-scheme: light dark; } }\n"
                                     "@media screen and (prefers-color-scheme: dark) {\n"
                                     "  :root { --ink: #e8e8e8; --grid: #444; --paper: #181818; }\n"
                                     "}\n";
constexpr const char* kStyleSheet =
    ".plot .paper { fill: var(--paper); }\n"
    ".plot text { font: 14px sans-serif; fill: var(--ink); }\n"
    ".plot .title { font-weight: bold; }\n"
    ".plot .grid { stroke: var(--grid); stroke-width: 1; }\n"
    ".plot .frame { fill: none; stroke: var(--ink); stroke-width: 1; }\n"
    ".plot .mark { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 2 3; }\n"
    ".plot .line { fill: none; stroke-width: 1.8; stroke-linejoin: round; }\n";

} // namespace

const char* drawing_colours()
{
    return kColourSheet;
}

const char* drawing_style()
{
    return kStyleSheet;
}

std::string to_svg_file(const Drawing& drawing)
{
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" width=\"{0:.0f}\" "
                       "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>\n{2}{3}"
                       "</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n{4}"
                       "</svg>\n",
                       kDrawingWidth, drawing.height, kColourSheet, kStyleSheet, drawing.body);
}

std::string to_svg_element(const Drawing& drawing)
{
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" role=\"img\" "
                       "aria-label=\"{}\" viewBox=\"0 0 {:.0f} {:.0f}\">\n{}</svg>\n",
                       escaped(drawing.title), kDrawingWidth, drawing.height, drawing.body);
}

const char* Look::colour() const
{
    return kColours.at(place_ % kColours.size());
}

std::string Look::stroke() const
{
    return fmt::format("stroke=\"{}\" stroke-dasharray=\"{}\"", colour(),
                       kDashes.at(place_ % kDashes.size()));
}

double width_of(const std::string& text)
{
    return kLetter * static_cast<double>(characters_of(text));
}

std::size_t characters_in(double width)
{
    return static_cast<std::size_t>(std::max(width / kLetter, 1.0));
}

Chart::Chart(Words words, const Axis& x, const Axis& y, std::vector<LegendEntry> legend)
    : words_(std::move(words)), x_(x), y_(y), legend_(std::move(legend))
{
    constexpr double kGap = 18.0;
    double at = left();
    double row = kLegendTop;
    for (LegendEntry& entry : legend_)
    {
        entry.name = shortened(entry.name, characters_in(right() - left() - kSample));
        const double end = at + kSample + width_of(entry.name);
        if (end > kDrawingWidth && at > left())
        {
            at = left();
            row += kLegendRow;
        }
        legend_x_.push_back(at);
        legend_y_.push_back(row);
        at += kSample + width_of(entry.name) + kGap;
    }
    top_ = legend_.empty() ? kLegendTop - 8.0 : row + 14.0;
}

double Chart::left() const
{
    return kLeft;
}

double Chart::right() const
{
    return kDrawingWidth - kRight;
}

double Chart::bottom() const
{
    return top_ + kPlotHeight;
}

double Chart::x_of(double value) const
{
    return left() + (right() - left()) * x_.share(value);
}

double Chart::y_of(double value) const
{
    return bottom() - kPlotHeight * y_.share(value);
}

Drawing Chart::around(const std::string& data) const
{
    const std::string title =
        fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left(), kTitle,
                    escaped(shortened(words_.title, characters_in(kDrawingWidth - left()))));
    const std::string frame = fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" "
                                          "width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
                                          left(), top_, right() - left(), kPlotHeight);
    return {words_.title, bottom() + kBelow, title + grid() + frame + labels() + legend() + data};
}

std::string Chart::grid() const
{
    constexpr std::size_t kTicksX = 9;
    constexpr std::size_t kTicksY = 5;
    std::string svg;
    const auto line = [&svg](const char* kind, double x1, double x2, double y1, double y2)
    {
        svg += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" "
                           "y2=\"{:.1f}\"/>\n",
                           kind, x1, x2, y1, y2);
    };
    const auto text = [&svg](double x, double y, const char* anchor, const std::string& word)
    {
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y,
                           anchor, escaped(word));
    };
    double free_from = 0.0; // No text over another.
    for (const Tick& tick : x_.ticks(kTicksX))
    {
        const double x = left() + (right() - left()) * tick.share;
        line("grid", x, x, top_, bottom());
        const double half = width_of(tick.text) / 2.0;
        if (x - half >= free_from)
        {
            text(x, bottom() + 18.0, "middle", tick.text);
            free_from = x + half + 4.0;
        }
    }
    double free_to = kDrawingWidth;
    for (const Tick& tick : y_.ticks(kTicksY))
    {
        const double y = bottom() - kPlotHeight * tick.share;
        line("grid", left(), right(), y, y);
        if (y <= free_to)
        {
            text(left() - 6.0, y + 5.0, "end", tick.text);
            free_to = y - 15.0;
        }
    }
    return svg;
}

std::string Chart::labels() const
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
                       "<text transform=\"translate(16 {:.1f}) rotate(-90)\" "
                       "text-anchor=\"middle\">{}</text>\n",
                       (left() + right()) / 2.0, bottom() + 38.0,
                       escaped(shortened(words_.x_label, characters_in(right() - left()))),
                       top_ + kPlotHeight / 2.0,
                       escaped(shortened(words_.y_label, characters_in(kPlotHeight + 40.0))));
}

std::string Chart::legend() const
{
    std::string svg;
    for (std::size_t i = 0; i < legend_.size(); ++i)
    {
        svg += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n"
                           "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                           legend_x_[i], legend_y_[i], legend_[i].sample, legend_x_[i] + kSample,
                           legend_y_[i] + 5.0, escaped(legend_[i].name));
    }
    return svg;
}

Drawing stacked(const std::vector<Drawing>& drawings)
{
    Drawing all;
    for (const Drawing& drawing : drawings)
    {
        all.title += (all.title.empty() ? "" : "; ") + drawing.title;
        all.body += fmt::format("<g transform=\"translate(0 {:.0f})\">\n{}</g>\n", all.height,
                                drawing.body);
        all.height += drawing.height;
    }
    return all;
}

} // namespace tactus::plot
