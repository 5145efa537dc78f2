// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/triangle_tree.hpp"

#include <limits>
#include <numeric>

namespace tactus::test
{

TriangleTree::TriangleTree(const std::vector<Triangle>& triangles)
{
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    nodes_.reserve(2 * triangles.size());
    build(triangles, order, 0, static_cast<std::uint32_t>(triangles.size()));
    refit(triangles);
}

void TriangleTree::build(const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& order,
                         std::uint32_t first, std::uint32_t count)
{
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (count == 1)
    {
        nodes_[index].triangle = order[first];
        return;
    }
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    const auto middle = [&](std::uint32_t i)
    { return Vec3(triangles[i][0] + triangles[i][1] + triangles[i][2]); };
    for (std::uint32_t i = first; i < first + count; ++i)
    {
        low = low.cwiseMin(middle(order[i]));
        high = high.cwiseMax(middle(order[i]));
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first);
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](std::uint32_t a, std::uint32_t b)
                     { return middle(a)[axis] < middle(b)[axis]; });
    build(triangles, order, first, count / 2);
    nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
    build(triangles, order, first + count / 2, count - count / 2);
}

void TriangleTree::refit(const std::vector<Triangle>& triangles)
{
    for (std::size_t i = nodes_.size(); i-- > 0;)
    {
        Node& node = nodes_[i];
        if (node.right == 0)
        {
            const Triangle& t = triangles[node.triangle];
            node.low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
            node.high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
            continue;
        }
        node.low = nodes_[i + 1].low.cwiseMin(nodes_[node.right].low);
        node.high = nodes_[i + 1].high.cwiseMax(nodes_[node.right].high);
    }
}

} // namespace tactus::test
