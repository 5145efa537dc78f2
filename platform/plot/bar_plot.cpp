// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/bar_plot.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::plot
{

namespace
{

constexpr double kNamesWidth = 150.0;
constexpr double kValuesWidth = 80.0; ///< For the longest bar's value.
constexpr double kTop = 32.0;
constexpr double kRow = 21.0;
constexpr double kGap = 8.0; ///< Above a group's name.
constexpr double kThickness = 14.0;

Axis axis_of(const BarPlot& plot)
{
    double most = 0.0;
    for (const BarGroup& group : plot.groups)
    {
        for (const Bar& bar : group.bars)
        {
            most = std::isfinite(bar.value) ? std::max(most, bar.value) : most;
        }
    }
    return Axis::linear(most);
}

/// The place of a bar's name among all different ones.
std::size_t place_of(const std::string& name, std::vector<std::string>& names)
{
    const auto found = std::ranges::find(names, name);
    const auto place = static_cast<std::size_t>(found - names.begin());
    if (found == names.end())
    {
        names.push_back(name);
    }
    return place;
}

std::string row_of(const Bar& bar, const Look& look, double share, double y)
{
    const double length = (kDrawingWidth - kNamesWidth - kValuesWidth) * share;
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n"
        "<rect fill=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n"
        "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        kNamesWidth - 8.0, y + 5.0, escaped(shortened(bar.name, characters_in(kNamesWidth - 8.0))),
        look.colour(), kNamesWidth, y - kThickness / 2.0, length, kThickness,
        kNamesWidth + length + 6.0, y + 5.0, number_text(bar.value));
}

} // namespace

Drawing draw(const BarPlot& plot)
{
    const Axis axis = axis_of(plot);
    std::vector<std::string> names;
    std::string rows;
    double y = kTop;
    for (const BarGroup& group : plot.groups)
    {
        if (!group.name.empty())
        {
            y += y > kTop ? kGap : 0.0;
            rows += fmt::format(
                "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kNamesWidth, y + 14.0,
                escaped(shortened(group.name, characters_in(kDrawingWidth - kNamesWidth))));
            y += kRow;
        }
        for (const Bar& bar : group.bars)
        {
            const double share = std::isfinite(bar.value) ? axis.share(bar.value) : 0.0;
            rows += row_of(bar, Look(place_of(bar.name, names)), share, y + kRow / 2.0);
            y += kRow;
        }
    }
    std::string grid;
    for (const Tick& tick : axis.ticks(5))
    {
        grid += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" "
                            "y2=\"{2:.1f}\"/>\n<text x=\"{0:.1f}\" y=\"{3:.1f}\" "
                            "text-anchor=\"middle\">{4}</text>\n",
                            kNamesWidth + (kDrawingWidth - kNamesWidth - kValuesWidth) * tick.share,
                            kTop, y + 4.0, y + 22.0, tick.text);
    }
    const std::string words =
        fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"20\">{}</text>\n"
                    "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                    8.0, escaped(shortened(plot.title, characters_in(kDrawingWidth - 8.0))),
                    (kNamesWidth + kDrawingWidth - kValuesWidth) / 2.0, y + 42.0,
                    escaped(shortened(plot.x_label, characters_in(kDrawingWidth - kNamesWidth))));
    return {plot.title, y + 54.0, words + grid + rows};
}

} // namespace tactus::plot
