// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/model_pieces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace tactus
{

namespace
{

/// A face and three times its centroid, which has integer coordinates.
struct Centroid
{
    std::array<std::int32_t, 3> sum{};
    std::uint32_t face{0};
};

std::vector<Centroid> centroids_of(const QuantisedMesh& mesh)
{
    std::vector<Centroid> centroids(mesh.faces.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
    {
        centroids[face].face = face;
        for (const std::uint32_t corner : mesh.faces[face])
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                centroids[face].sum[axis] += mesh.positions[corner][axis];
            }
        }
    }
    return centroids;
}

std::size_t longest_axis(std::span<const Centroid> cell)
{
    std::array<std::int32_t, 3> low = cell.front().sum;
    std::array<std::int32_t, 3> high = low;
    for (const Centroid& centroid : cell)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], centroid.sum[axis]);
            high[axis] = std::max(high[axis], centroid.sum[axis]);
        }
    }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
    {
        if (high[axis] - low[axis] > high[longest] - low[longest])
        {
            longest = axis;
        }
    }
    return longest;
}

/// Orders a cell. Cells of at most eight faces stay unordered: each is one bucket, since its first
/// rank is a multiple of eight. Every left part of a larger cell has a power of two of faces, at
/// least eight.
void order_cell(std::span<Centroid> cell)
{
    while (cell.size() > 8)
    {
        const std::size_t axis = longest_axis(cell);
        const std::size_t left = std::bit_floor(cell.size() - 1);
        std::nth_element(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(left), cell.end(),
                         [axis](const Centroid& a, const Centroid& b) {
                             return a.sum[axis] != b.sum[axis] ? a.sum[axis] < b.sum[axis]
                                                               : a.face < b.face;
                         });
        // The right part is never larger than the left one: at most 32 levels.
        order_cell(cell.subspan(left));
        cell = cell.first(left);
    }
}

} // namespace

std::vector<std::uint32_t> left_full_buckets(const QuantisedMesh& mesh)
{
    std::vector<Centroid> centroids = centroids_of(mesh);
    order_cell(centroids);
    std::vector<std::uint32_t> buckets(centroids.size());
    for (std::size_t rank = 0; rank < centroids.size(); ++rank)
    {
        buckets[centroids[rank].face] = static_cast<std::uint32_t>(rank >> 3U);
    }
    return buckets;
}

} // namespace tactus
