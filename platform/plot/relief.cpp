// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/relief.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tactus::plot
{

namespace
{

using Vector = std::array<double, 3>;

// Axes of the view: perpendicular unit vectors. The eye is to the right, in front and above.
constexpr Vector kRight{0.8192, 0.5736, 0.0};
constexpr Vector kUp{-0.2868, 0.4096, 0.8660};
constexpr Vector kToEye{0.4967, -0.7094, 0.5};

constexpr std::size_t kShades = 8;
constexpr std::size_t kColours = 6; ///< The first is for the amount 0.
constexpr double kWidth = 1000.0;   ///< Width of a view, in its own units.
constexpr double kNearShare = 0.4;  ///< Share of a picture below which the paths get a second view.

double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector to_vector(const Place& place)
{
    return {static_cast<double>(place[0]), static_cast<double>(place[1]),
            static_cast<double>(place[2])};
}

/// Point on the screen, y down, and its depth towards the eye.
struct Seen
{
    double x{0.0};
    double y{0.0};
    double depth{0.0};
};

Seen seen(const Place& place)
{
    const Vector at = to_vector(place);
    return {dot(at, kRight), -dot(at, kUp), dot(at, kToEye)};
}

struct Frame
{
    double low_x{std::numeric_limits<double>::max()};
    double low_y{low_x};
    double high_x{-low_x};
    double high_y{-low_x};

    void take(const Seen& at)
    {
        low_x = std::min(low_x, at.x);
        low_y = std::min(low_y, at.y);
        high_x = std::max(high_x, at.x);
        high_y = std::max(high_y, at.y);
    }
    [[nodiscard]] double size() const { return std::max(high_x - low_x, high_y - low_y); }
    [[nodiscard]] Frame grown(double by) const
    {
        Frame frame = *this;
        frame.low_x -= by;
        frame.low_y -= by;
        frame.high_x += by;
        frame.high_y += by;
        return frame;
    }
};

/// Converts lengths of the scene to those of the picture.
struct Scale
{
    Frame frame;
    double factor{1.0};

    explicit Scale(const Frame& all)
        : frame(all.grown(0.03 * std::max(all.size(), 1e-9)))
        , factor(kWidth / std::max(frame.size(), 1e-9))
    {
    }
    [[nodiscard]] std::string text(const Seen& at) const
    {
        return fmt::format("{:.1f} {:.1f}", factor * (at.x - frame.low_x),
                           factor * (at.y - frame.low_y));
    }
    /// View box of this part of the picture.
    [[nodiscard]] std::string window(const Frame& part) const
    {
        return fmt::format("{:.1f} {:.1f} {:.1f} {:.1f}", factor * (part.low_x - frame.low_x),
                           factor * (part.low_y - frame.low_y), factor * (part.high_x - part.low_x),
                           factor * (part.high_y - part.low_y));
    }
};

/// Shade of a face: lighter the more it faces the eye.
std::size_t shade_of(const std::array<Place, 3>& face)
{
    const Vector a = to_vector(face[0]);
    Vector u = to_vector(face[1]);
    Vector v = to_vector(face[2]);
    for (std::size_t i = 0; i < 3; ++i)
    {
        u[i] -= a[i];
        v[i] -= a[i];
    }
    const Vector normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                        u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(dot(normal, normal));
    const double facing = length > 0.0 ? std::abs(dot(normal, kToEye)) / length : 0.0;
    return std::min(static_cast<std::size_t>(facing * kShades), kShades - 1);
}

/// Draws the farthest faces first, so that nearer ones hide them.
std::string drawn(const std::vector<std::array<Place, 3>>& faces, const Scale& scale)
{
    struct Drawn
    {
        double depth;
        std::size_t face;
    };
    std::vector<Drawn> order;
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        order.push_back(
            {seen(faces[i][0]).depth + seen(faces[i][1]).depth + seen(faces[i][2]).depth, i});
    }
    std::ranges::stable_sort(order, {}, &Drawn::depth);
    std::string text;
    for (const Drawn& each : order)
    {
        const std::array<Place, 3>& face = faces[each.face];
        text += fmt::format("<path class=\"s{}\" d=\"M{}L{}L{}Z\"/>\n", shade_of(face),
                            scale.text(seen(face[0])), scale.text(seen(face[1])),
                            scale.text(seen(face[2])));
    }
    return text;
}

std::size_t colour_of(float amount, float most)
{
    return amount <= 0.0F || most <= 0.0F
               ? 0
               : std::min(1 + static_cast<std::size_t>(amount / most * (kColours - 1)),
                          kColours - 1);
}

/// Draws a path as segments of one colour, each up to the start of the next.
std::string drawn(const std::vector<WayPoint>& way, float most, const Scale& scale)
{
    std::string text;
    for (std::size_t begin = 0; begin + 1 < way.size();)
    {
        const std::size_t colour = colour_of(way[begin + 1].amount, most);
        text +=
            fmt::format("<path class=\"w w{}\" d=\"M{}", colour, scale.text(seen(way[begin].at)));
        do
        {
            text += "L" + scale.text(seen(way[++begin].at));
        } while (begin + 1 < way.size() && colour_of(way[begin + 1].amount, most) == colour);
        text += "\"/>\n";
    }
    return text;
}

/// Legend of the colours.
std::string legend_of(float most, const std::string& unit)
{
    std::string text = "<div class=\"legend\"><span class=\"k0\">&#9473;&#9473;</span> none";
    for (std::size_t colour = 1; colour < kColours; ++colour)
    {
        text += fmt::format(" <span class=\"k{}\">&#9473;&#9473;</span> {:.3g}", colour,
                            most * static_cast<float>(colour) / (kColours - 1));
    }
    return text + " " + escaped(unit) + " at most</div>\n";
}

} // namespace

std::string figure_of(const Relief& relief)
{
    Frame all;
    Frame ways;
    float most = 0.0F;
    for (const std::array<Place, 3>& face : relief.faces)
    {
        std::ranges::for_each(face, [&](const Place& place) { all.take(seen(place)); });
    }
    for (const std::vector<WayPoint>& way : relief.ways)
    {
        for (const WayPoint& point : way)
        {
            ways.take(seen(point.at));
            all.take(seen(point.at));
            most = std::max(most, point.amount);
        }
    }
    if (relief.is_empty() || !std::isfinite(all.size()) || all.size() <= 0.0)
    {
        return {};
    }
    const Scale scale(all);
    std::string text = fmt::format(
        "<figure>\n<figcaption>{}</figcaption>\n<div class=\"reliefs\">\n<svg class=\"relief\" "
        "xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"{}\">\n<g id=\"relief\">\n",
        escaped(relief.title), scale.window(scale.frame));
    text += drawn(relief.faces, scale);
    for (const std::vector<WayPoint>& way : relief.ways)
    {
        text += drawn(way, most, scale);
    }
    text += "</g>\n</svg>\n";
    if (ways.size() > 0.0 && ways.size() < kNearShare * all.size())
    {
        text += fmt::format("<svg class=\"relief\" xmlns=\"http://www.w3.org/2000/svg\" "
                            "role=\"img\" viewBox=\"{}\"><use href=\"#relief\"/></svg>\n",
                            scale.window(ways.grown(0.2 * ways.size())));
    }
    text += "</div>\n";
    if (!relief.ways.empty())
    {
        text += legend_of(most, relief.unit);
    }
    if (!relief.note.empty())
    {
        text += "<p class=\"note\">" + escaped(relief.note) + "</p>\n";
    }
    return text + "</figure>\n";
}

std::string relief_style()
{
    // Each colour has a class, since selectors of ancestors don't reach into a <use>. The colours
    // go from grey for none to the largest amount.
    constexpr std::array<const char*, kColours> light{"#8a8a8a", "#3b6fb6", "#1b8a6b",
                                                      "#b07a00", "#d2521c", "#c00030"};
    constexpr std::array<const char*, kColours> dark{"#8f8f8f", "#6fa8ff", "#42d0a4",
                                                     "#f0b73a", "#ff8a4d", "#ff5577"};
    std::string text = ".reliefs { display: flex; flex-wrap: wrap; gap: 1rem; }\n"
                       ".relief { flex: 1 1 18rem; min-width: 0; max-height: 32rem; }\n"
                       ".w { fill: none; stroke-width: 2; stroke-linejoin: round;\n"
                       "  stroke-linecap: round; vector-effect: non-scaling-stroke; }\n"
                       ".w0 { stroke-width: 1; }\n";
    const auto scheme =
        [&text](const std::array<const char*, kColours>& colours, int least, int most)
    {
        for (std::size_t i = 0; i < kShades; ++i)
        {
            const int grey =
                least + (most - least) * static_cast<int>(i) / static_cast<int>(kShades - 1);
            text += fmt::format(".s{0} {{ fill: #{1:02x}{1:02x}{1:02x}; stroke: "
                                "#{1:02x}{1:02x}{1:02x}; }}\n",
                                i, grey);
        }
        for (std::size_t i = 0; i < kColours; ++i)
        {
            text +=
                fmt::format(".w{0} {{ stroke: {1}; }} .k{0} {{ color: {1}; }}\n", i, colours.at(i));
        }
    };
    scheme(light, 150, 236);
    text += "@media screen and (prefers-color-scheme: dark) {\n";
    scheme(dark, 40, 104);
    return text + "}\n";
}

} // namespace tactus::plot
