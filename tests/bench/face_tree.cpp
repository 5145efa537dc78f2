// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/face_tree.hpp"

#include "tests/bench/closest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tactus::bench
{

namespace
{

Point<double> widened(const Vec3f& v)
{
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

} // namespace

FaceTree::FaceTree(const std::vector<test::Face>& faces) : faces_(faces), order_(faces.size())
{
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(faces.size() / 2 + 1);
    build(0, static_cast<std::uint32_t>(faces.size()));
}

void FaceTree::build(std::uint32_t first, std::uint32_t count)
{
    const std::size_t index = nodes_.size();
    Node node;
    node.low.setConstant(std::numeric_limits<double>::infinity());
    node.high = -node.low;
    for (std::uint32_t i = first; i < first + count; ++i)
    {
        for (const Vec3f& corner : faces_[order_[i]])
        {
            node.low = node.low.cwiseMin(to_vec3(corner));
            node.high = node.high.cwiseMax(to_vec3(corner));
        }
    }
    node.first = first;
    node.count = count;
    nodes_.push_back(node);
    if (count <= kLeafFaces)
    {
        return;
    }
    Eigen::Index axis = 0;
    (node.high - node.low).maxCoeff(&axis);
    const auto key = [&](std::uint32_t face)
    {
        const auto at = static_cast<std::size_t>(axis);
        return faces_[face][0][at] + faces_[face][1][at] + faces_[face][2][at];
    };
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    build(first, count / 2);
    nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
    build(first + count / 2, count - count / 2);
}

FaceTree::Nearest FaceTree::nearest(const Vec3& point_m) const
{
    Nearest best{std::numeric_limits<double>::infinity(), {}};
    search(0, point_m, best);
    return best;
}

void FaceTree::search(std::uint32_t index, const Vec3& point_m, Nearest& best) const
{
    const Node& node = nodes_[index];
    if (node.right != 0)
    {
        std::uint32_t near = index + 1;
        std::uint32_t far = node.right;
        if (box_distance(far, point_m) < box_distance(near, point_m))
        {
            std::swap(near, far);
        }
        for (const std::uint32_t child : {near, far})
        {
            if (box_distance(child, point_m) < best.distance_m)
            {
                search(child, point_m, best);
            }
        }
        return;
    }
    const Point<double> p{point_m.x(), point_m.y(), point_m.z()};
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
        const test::Face& face = faces_[order_[i]];
        const Point<double> foot =
            closest_on_triangle(p, widened(face[0]), widened(face[1]), widened(face[2]));
        const Point<double> gap = difference(p, foot);
        if (const double distance = std::sqrt(dot(gap, gap)); distance < best.distance_m)
        {
            best = {distance, Vec3(foot[0], foot[1], foot[2])};
        }
    }
}

double FaceTree::box_distance(std::uint32_t index, const Vec3& point_m) const
{
    const Node& node = nodes_[index];
    const Vec3 outside = (node.low - point_m).cwiseMax(point_m - node.high);
    return outside.cwiseMax(Vec3(0.0, 0.0, 0.0)).norm();
}

} // namespace tactus::bench
