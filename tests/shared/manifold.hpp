// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test
{

using Corners = std::array<std::uint32_t, 3>;

/// Corners rotated so that the least is first: equal for the same oriented face.
[[nodiscard]] inline Corners turned(Corners corners)
{
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    return corners;
}

/// True if faces, given by their directed edges opposite to a vertex, form one fan around it.
[[nodiscard]] inline bool is_one_fan(std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite)
{
    // The walk begins at a corner at which no other face ends, or anywhere if the fan is closed.
    const auto begins = std::find_if(
        opposite.begin(), opposite.end(),
        [&](const auto& edge)
        {
            return std::none_of(opposite.begin(), opposite.end(),
                                [&](const auto& other) { return other.second == edge.first; });
        });
    auto here = begins == opposite.end() ? opposite.begin() : begins;
    for (std::size_t left = opposite.size(); left > 1; --left)
    {
        const std::uint32_t corner = here->second;
        opposite.erase(here);
        here = std::find_if(opposite.begin(), opposite.end(),
                            [&](const auto& edge) { return edge.first == corner; });
        if (here == opposite.end())
        {
            return false;
        }
    }
    return true;
}

/// Reason why the faces are not 2-manifold with borders; empty if they are.
[[nodiscard]] inline std::string manifold_fault(std::span<const Corners> faces)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> opposite;
    for (const Corners& face : faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::uint32_t next = face[(i + 1) % 3];
            if (face[i] == next || !edges.emplace(face[i], next).second)
            {
                return "edge " + std::to_string(face[i]) + " " + std::to_string(next);
            }
            opposite[face[i]].emplace_back(next, face[(i + 2) % 3]);
        }
    }
    for (const auto& [vertex, fan] : opposite)
    {
        if (!is_one_fan(fan))
        {
            return "vertex " + std::to_string(vertex);
        }
    }
    return {};
}

} // namespace tactus::test
