// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/face_tree.hpp"

#include "tests/shared/distance_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus::test
{

namespace
{

Point<double> widened(const Vec3f& v)
{
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

} // namespace

FaceTree::FaceTree(const std::vector<Face>& faces, std::span<const double> bounds_m)
    : faces_(faces), bounds_m_(bounds_m), order_(faces.size())
{
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(faces.size() / 2 + 1);
    build(0, static_cast<std::uint32_t>(faces.size()));
}

void FaceTree::build(std::uint32_t first, std::uint32_t count)
{
    const std::size_t index = nodes_.size();
    Node node;
    node.first = first;
    node.count = count;
    find_box(node);
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

void FaceTree::find_box(Node& node) const
{
    node.low.setConstant(std::numeric_limits<double>::infinity());
    node.high = -node.low;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
        for (const Vec3f& corner : faces_[order_[i]])
        {
            node.low = node.low.cwiseMin(to_vec3(corner));
            node.high = node.high.cwiseMax(to_vec3(corner));
        }
        node.bound = std::max(node.bound, bound_of(order_[i]));
    }
}

FaceTree::Nearest FaceTree::nearest(const Vec3& point_m) const
{
    Search sought{point_m};
    search(0, sought);
    return sought.best;
}

double FaceTree::least_excess(const Vec3& point_m, double enough_m) const
{
    Search sought{point_m, true, enough_m};
    search(0, sought);
    return sought.least;
}

void FaceTree::search(std::uint32_t index, Search& sought) const
{
    const Node& node = nodes_[index];
    if (node.right == 0)
    {
        search_leaf(node, sought);
        return;
    }
    std::uint32_t near = index + 1;
    std::uint32_t far = node.right;
    double near_bound = lower_bound(near, sought);
    double far_bound = lower_bound(far, sought);
    if (far_bound < near_bound)
    {
        std::swap(near, far);
        std::swap(near_bound, far_bound);
    }
    if (near_bound < sought.least)
    {
        search(near, sought);
    }
    if (far_bound < sought.least && sought.least > sought.enough)
    {
        search(far, sought);
    }
}

void FaceTree::search_leaf(const Node& node, Search& sought) const
{
    const Vec3& point_m = sought.point_m;
    const Point<double> p{point_m.x(), point_m.y(), point_m.z()};
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
        const std::uint32_t id = order_[i];
        const Face& face = faces_[id];
        const Point<double> foot =
            closest_on_triangle(p, widened(face[0]), widened(face[1]), widened(face[2]));
        const Point<double> gap = difference(p, foot);
        const double distance = std::sqrt(dot(gap, gap));
        const double value = sought.subtracts_bounds ? distance - bound_of(id) : distance;
        if (value < sought.least)
        {
            sought.least = value;
            sought.best = {distance, Vec3(foot[0], foot[1], foot[2]), id};
        }
    }
}

FaceTree::WideNearest FaceTree::wide_nearest(const Point<long double>& point_m) const
{
    WideNearest best;
    const Vec3 rounded(static_cast<double>(point_m[0]), static_cast<double>(point_m[1]),
                       static_cast<double>(point_m[2]));
    search_wide(0, point_m, {rounded}, best);
    return best;
}

void FaceTree::search_wide(std::uint32_t index, const Point<long double>& point_m,
                           const Search& sought, WideNearest& best) const
{
    // The slack is far above the rounding of a box's distance.
    const double slack =
        1e-14 * (sought.point_m.cwiseAbs().maxCoeff() + (high_m() - low_m()).sum());
    const auto may_be_nearer = [&](std::uint32_t node)
    { return static_cast<long double>(lower_bound(node, sought) - slack) < best.distance_m; };
    const Node& node = nodes_[index];
    if (node.right == 0)
    {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        {
            const long double distance = wide_distance(point_m, faces_[order_[i]]);
            if (distance < best.distance_m)
            {
                best = {distance, order_[i]};
            }
        }
        return;
    }
    std::uint32_t near = index + 1;
    std::uint32_t far = node.right;
    if (lower_bound(far, sought) < lower_bound(near, sought))
    {
        std::swap(near, far);
    }
    for (const std::uint32_t child : {near, far})
    {
        if (may_be_nearer(child))
        {
            search_wide(child, point_m, sought, best);
        }
    }
}

std::vector<std::uint32_t> FaceTree::faces_near_box(const Vec3& low_m, const Vec3& high_m) const
{
    std::vector<std::uint32_t> found;
    collect(0, low_m, high_m, found);
    return found;
}

void FaceTree::collect(std::uint32_t index, const Vec3& low_m, const Vec3& high_m,
                       std::vector<std::uint32_t>& found) const
{
    const Node& node = nodes_[index];
    if ((node.high.array() < low_m.array()).any() || (node.low.array() > high_m.array()).any())
    {
        return;
    }
    if (node.right == 0)
    {
        const auto first = order_.begin() + static_cast<std::ptrdiff_t>(node.first);
        found.insert(found.end(), first, first + node.count);
        return;
    }
    collect(index + 1, low_m, high_m, found);
    collect(node.right, low_m, high_m, found);
}

double FaceTree::lower_bound(std::uint32_t index, const Search& sought) const
{
    const Node& node = nodes_[index];
    const Vec3 outside = (node.low - sought.point_m).cwiseMax(sought.point_m - node.high);
    const double distance = outside.cwiseMax(Vec3(0.0, 0.0, 0.0)).norm();
    return sought.subtracts_bounds ? distance - node.bound : distance;
}

} // namespace tactus::test
