// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/sampled_distance.hpp"

#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/simplify/point_triangle.hpp"
#include "rt_core/base/assert.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tactus
{

namespace
{

using Corners = std::array<Vec3, 3>;

Corners corners_of(const QuantisedMesh& mesh, const std::array<std::uint32_t, 3>& face)
{
    return {grid_point(mesh, face[0]), grid_point(mesh, face[1]), grid_point(mesh, face[2])};
}

double area_of(const Corners& corners)
{
    return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
}

/// Tree over the base mesh's faces, halved repeatedly at the median of the longest axis.
class BaseTree
{
public:
    BaseTree(const QuantisedMesh& mesh, const Simplification& simplification)
    {
        leaves_.reserve(simplification.base_corners.size());
        for (const auto& face : simplification.base_corners)
        {
            const Corners corners = corners_of(mesh, face);
            Leaf& leaf = leaves_.emplace_back();
            leaf.triangle = DistanceTriangle(corners[0], corners[1], corners[2]);
            for (const Vec3& corner : corners)
            {
                leaf.box.extend(corner);
            }
        }
        nodes_.reserve(2 * leaves_.size());
        build(0, leaves_.size());
        point_.push_back(Vec3::Zero());
    }

    [[nodiscard]] double squared_distance(const Vec3& point)
    {
        point_.clear();
        point_.push_back(point);
        double least = std::numeric_limits<double>::infinity();
        search(0, point, least);
        return least;
    }

private:
    struct Leaf
    {
        DistanceTriangle triangle;
        Eigen::AlignedBox3d box;
    };
    /// The left child of an inner node is the next node; a leaf has `right` 0.
    struct Node
    {
        Eigen::AlignedBox3d box;
        std::size_t right{0};
        std::size_t leaf{0};
    };

    void build(std::size_t begin, std::size_t end)
    {
        const std::size_t index = nodes_.size();
        Node& node = nodes_.emplace_back();
        Eigen::AlignedBox3d centers;
        for (std::size_t i = begin; i < end; ++i)
        {
            node.box.extend(leaves_[i].box);
            centers.extend(leaves_[i].box.center());
        }
        if (end - begin == 1)
        {
            node.leaf = begin;
            return;
        }
        Eigen::Index axis = 0;
        centers.sizes().maxCoeff(&axis);
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return leaves_.begin() + static_cast<long>(i); };
        std::nth_element(at(begin), at(middle), at(end),
                         [axis](const Leaf& a, const Leaf& b)
                         { return a.box.center()[axis] < b.box.center()[axis]; });
        build(begin, middle);
        nodes_[index].right = nodes_.size();
        build(middle, end);
    }

    void search(std::size_t index, const Vec3& point, double& least) const
    {
        const Node& node = nodes_[index];
        if (node.right == 0)
        {
            double squared = 0.0;
            leaves_[node.leaf].triangle.squared_distances(point_, 0, &squared);
            least = std::min(least, squared);
            return;
        }
        std::array<std::size_t, 2> children{index + 1, node.right};
        std::array<double, 2> distances{nodes_[children[0]].box.squaredExteriorDistance(point),
                                        nodes_[children[1]].box.squaredExteriorDistance(point)};
        if (distances[1] < distances[0])
        {
            std::swap(children[0], children[1]);
            std::swap(distances[0], distances[1]);
        }
        for (std::size_t i = 0; i < 2; ++i)
        {
            if (distances[i] < least)
            {
                search(children[i], point, least);
            }
        }
    }

    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
    PointColumns point_; ///< Query point in the kernel's form.
};

/// Next random number, uniform in [0, 1), the same on every machine.
double unit_from(std::mt19937_64& random)
{
    return static_cast<double>(random() >> 11U) * 0x1p-53;
}

Vec3 point_on(const Corners& corners, std::mt19937_64& random)
{
    double s = unit_from(random);
    double t = unit_from(random);
    if (s + t > 1.0)
    {
        s = 1.0 - s;
        t = 1.0 - t;
    }
    return corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
}

} // namespace

double sampled_distance_to_base(const QuantisedMesh& mesh, const Simplification& simplification,
                                std::uint32_t samples, std::uint64_t seed)
{
    TACTUS_ASSERT(samples > 0 && !simplification.base_corners.empty());
    BaseTree base(mesh, simplification);
    double area = 0.0;
    for (const auto& face : mesh.faces)
    {
        area += area_of(corners_of(mesh, face));
    }
    std::mt19937_64 random(seed);
    double largest = 0.0;
    double passed = 0.0; // Area of the faces already visited.
    std::uint32_t taken = 0;
    const auto next_at = [&] { return (taken + unit_from(random)) / samples * area; };
    double next = next_at();
    for (const auto& face : mesh.faces)
    {
        const Corners corners = corners_of(mesh, face);
        passed += area_of(corners);
        while (taken < samples && next <= passed)
        {
            largest = std::max(largest, base.squared_distance(point_on(corners, random)));
            ++taken;
            next = next_at();
        }
    }
    return std::sqrt(largest);
}

} // namespace tactus
