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

/// A place of a way, and how much there is of what its colour shows.
struct WayPoint
{
    Place at{};
    float amount{0.0F};
};

/// Surfaces and the ways along them, seen from the front, the right and above; z is up.
struct Relief
{
    std::string title;
    std::vector<std::array<Place, 3>> faces;
    std::vector<std::vector<WayPoint>> ways; ///< Each in its order, over the surfaces.
    std::string unit;                        ///< Of the amounts.
    std::string note;                        ///< Below it; may be empty.

    [[nodiscard]] bool is_empty() const { return faces.empty() && ways.empty(); }
};

/// As a figure of HTML that is well-formed XML, too, for a page that has relief_style(). Where the
/// ways take little of the room there is a second view of their surroundings. Without a way or a
/// face nothing is drawn.
[[nodiscard]] std::string figure_of(const Relief& relief);

/// Shades of surfaces and colours of ways, light and dark.
[[nodiscard]] std::string relief_style();

} // namespace tactus::plot
