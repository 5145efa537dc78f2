// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/grid_point.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/static_vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <span>

namespace tactus
{

/// Nearest neighbours among some vertices of a mesh.
class VertexSearch
{
public:
    /// `vertices` must outlive the search.
    VertexSearch(const QuantisedMesh& mesh, std::span<const std::uint32_t> vertices)
        : points_{mesh, vertices}, tree_(3, points_)
    {
    }

    /// The 12 nearest to a vertex of the mesh, nearest first; fewer when there aren't as many.
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
            found.push_back(points_.vertices[places[i]]);
        }
        return found;
    }

private:
    struct Points
    {
        const QuantisedMesh& mesh;
        std::span<const std::uint32_t> vertices;

        // What nanoflann asks for.
        [[nodiscard]] std::size_t kdtree_get_point_count() const { return vertices.size(); }
        [[nodiscard]] double kdtree_get_pt(std::size_t place, std::size_t axis) const
        {
            return mesh.positions[vertices[place]][axis];
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
