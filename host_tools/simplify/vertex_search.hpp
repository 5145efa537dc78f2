// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/static_vector.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <numeric>
#include <span>
#include <vector>

namespace tactus
{

/// Nearest neighbours among some vertices of a mesh. Vertices at one position, such as those of
/// thousands of faces around one edge, are one point of the search tree: a tree of equal points
/// would visit all of them each time.
class VertexSearch
{
public:
    /// `vertices` must ascend.
    VertexSearch(const QuantisedMesh& mesh, std::span<const std::uint32_t> vertices)
        : points_(mesh, vertices), tree_(3, points_)
    {
    }

    /// Number of distinct positions of the vertices.
    [[nodiscard]] std::size_t place_count() const noexcept
    {
        return points_.kdtree_get_point_count();
    }

    /// Returns the 12 vertices nearest to a vertex of the mesh, nearest first; fewer if fewer
    /// exist. Vertices at one position come in ascending order from the first number above
    /// `vertex`, then wrap around, so that coincident vertices get different neighbours.
    [[nodiscard]] StaticVector<std::uint32_t, 12> nearest(std::uint32_t vertex) const
    {
        std::array<std::uint32_t, 12> places{};
        std::array<double, 12> squared{};
        const Vec3 point = grid_point(points_.mesh, vertex);
        const std::size_t count =
            tree_.knnSearch(point.data(), places.size(), places.data(), squared.data());
        StaticVector<std::uint32_t, 12> found;
        for (std::size_t i = 0; i < count; ++i)
        {
            const std::span<const std::uint32_t> crowd = points_.vertices_at(places[i]);
            const auto next = std::ranges::upper_bound(crowd, vertex) - crowd.begin();
            for (std::size_t k = 0; k < crowd.size(); ++k)
            {
                if (!found.try_push_back(
                        crowd[(static_cast<std::size_t>(next) + k) % crowd.size()]))
                {
                    return found;
                }
            }
        }
        return found;
    }

private:
    struct Points
    {
        const QuantisedMesh& mesh;
        std::vector<std::uint32_t> vertices; ///< Vertices, grouped by place (distinct position).
        /// First index of each place's group; the last entry is the number of vertices.
        std::vector<std::size_t> begins;

        /// Places are in the order of their first vertices.
        Points(const QuantisedMesh& of, std::span<const std::uint32_t> given) : mesh(of)
        {
            const auto position = [&](std::size_t i) { return mesh.positions[given[i]]; };
            std::vector<std::size_t> order(given.size());
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::ranges::stable_sort(order, {}, position);
            std::vector<std::size_t> first_of(given.size()); // First vertex of each vertex's place.
            for (std::size_t i = 0; i < order.size(); ++i)
            {
                const bool is_new = i == 0 || position(order[i]) != position(order[i - 1]);
                first_of[order[i]] = is_new ? order[i] : first_of[order[i - 1]];
            }
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::ranges::stable_sort(order, {}, [&](std::size_t i) { return first_of[i]; });
            for (std::size_t i = 0; i < order.size(); ++i)
            {
                if (first_of[order[i]] == order[i])
                {
                    begins.push_back(i);
                }
                vertices.push_back(given[order[i]]);
            }
            begins.push_back(order.size());
        }

        [[nodiscard]] std::span<const std::uint32_t> vertices_at(std::size_t place) const
        {
            return std::span(vertices).subspan(begins[place], begins[place + 1] - begins[place]);
        }

        // Interface that nanoflann requires.
        [[nodiscard]] std::size_t kdtree_get_point_count() const { return begins.size() - 1; }
        [[nodiscard]] double kdtree_get_pt(std::size_t place, std::size_t axis) const
        {
            return mesh.positions[vertices[begins[place]]][axis];
        }
        template <typename Box>
        [[nodiscard]] bool kdtree_get_bbox(Box& /*box*/) const
        {
            return false;
        }
    };
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>,
                                                     Points, 3, std::uint32_t>;

    Points points_;
    Tree tree_;
};

} // namespace tactus
