// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/changed_face.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::test
{

/// The finest mesh of a tree test, without an encoder: a height field of columns x rows squares in
/// two exact faces each, and the paths that a left-full median order gives them. Prim and face id
/// are the place in `faces`; `order` lists the places by rank.
struct FaceGrid
{
    std::vector<ChangedFace> faces;
    std::vector<std::uint32_t> order;
};

namespace detail
{

/// A face's centroid, three times over, so that it stays an integer.
struct RankedFace
{
    std::array<std::uint32_t, 2> place{};
    std::uint32_t face{0};
};

/// Halves a run at the median of its longer side; the left part is the largest power of two below.
inline void order_left_full(std::span<RankedFace> run)
{
    while (run.size() > 1)
    {
        std::array<std::uint32_t, 2> low = run.front().place;
        std::array<std::uint32_t, 2> high = run.front().place;
        for (const RankedFace& face : run)
        {
            for (std::size_t axis = 0; axis < 2; ++axis)
            {
                low[axis] = std::min(low[axis], face.place[axis]);
                high[axis] = std::max(high[axis], face.place[axis]);
            }
        }
        const std::size_t axis = high[0] - low[0] >= high[1] - low[1] ? 0 : 1;
        const std::size_t left = std::bit_floor(run.size() - 1);
        std::nth_element(run.begin(), run.begin() + static_cast<std::ptrdiff_t>(left), run.end(),
                         [axis](const RankedFace& a, const RankedFace& b) {
                             return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis]
                                                                   : a.face < b.face;
                         });
        order_left_full(run.first(left));
        run = run.subspan(left);
    }
}

} // namespace detail

[[nodiscard]] inline FaceGrid make_face_grid(std::uint32_t columns, std::uint32_t rows)
{
    FaceGrid grid;
    std::vector<detail::RankedFace> ranked;
    const auto vertex = [](std::uint32_t x, std::uint32_t y)
    {
        const std::uint32_t bump = (x * 7 + y * 13) % 5;
        return Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(bump)};
    };
    for (std::uint32_t y = 0; y < rows; ++y)
    {
        for (std::uint32_t x = 0; x < columns; ++x)
        {
            for (std::uint32_t half = 0; half < 2; ++half)
            {
                const auto place = static_cast<std::uint32_t>(grid.faces.size());
                const Vec3f third = half == 0 ? vertex(x + 1, y) : vertex(x, y + 1);
                ChangedFace face{PrimId{place}, FaceId{place}, 0, 0, {}};
                face.corners_m = half == 0 ? std::array{vertex(x, y), third, vertex(x + 1, y + 1)}
                                           : std::array{vertex(x, y), vertex(x + 1, y + 1), third};
                grid.faces.push_back(face);
                ranked.push_back({{3 * x + 2 - half, 3 * y + 1 + half}, place});
            }
        }
    }
    detail::order_left_full(ranked);
    grid.order.reserve(ranked.size());
    for (const detail::RankedFace& face : ranked)
    {
        grid.faces[face.face].bucket = static_cast<std::uint32_t>(grid.order.size()) >> 3U;
        grid.order.push_back(face.face);
    }
    return grid;
}

} // namespace tactus::test
