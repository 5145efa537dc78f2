// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <string>
#include <vector>

// Any thread, but not the haptic one: texts allocate.
namespace tactus::plot
{

using Place = std::array<float, 3>;

/// A point of a path, and the amount that its colour shows.
struct WayPoint
{
    Place at{};
    float amount{0.0F};
};

/// Surfaces and the paths along them, seen from the front, the right and above; z is up.
struct Relief
{
    std::string title;
    std::vector<std::array<Place, 3>> faces;
    std::vector<std::vector<WayPoint>> ways; ///< Paths along the surfaces, points in order.
    std::string unit;                        ///< Unit of the amounts.
    std::string note;                        ///< Note below the figure; may be empty.

    [[nodiscard]] bool is_empty() const { return faces.empty() && ways.empty(); }
};

/// HTML figure that is well-formed XML, too; its page must include relief_style(). If the paths
/// fill only a small part of the figure, a second view enlarges them. Empty text without a path or
/// a face.
[[nodiscard]] std::string figure_of(const Relief& relief);

/// CSS rules for figures: shades of surfaces and colours of paths, for light and dark pages.
[[nodiscard]] std::string relief_style();

} // namespace tactus::plot
