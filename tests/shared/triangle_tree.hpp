// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tactus::test
{

/// Plain binary box tree, one triangle a leaf, for pairs of triangles of two meshes. Boxes have the
/// corners' own coordinates, so overlap is exact.
class TriangleTree
{
public:
    explicit TriangleTree(const std::vector<Triangle>& triangles);

    /// Moves the same triangles; updates the boxes and keeps the order.
    void refit(const std::vector<Triangle>& triangles);

    /// Calls visit(a, b) for the pairs of triangles whose boxes are at most limit() apart, right up
    /// to rounding and exact at 0. Near pairs come first, so that the limit may shrink.
    template <typename Limit, typename Visit>
    static void visit_pairs(const TriangleTree& a, const TriangleTree& b, const Limit& limit,
                            const Visit& visit)
    {
        visit_below(a, 0, b, 0, limit, visit);
    }

private:
    /// Node; its left child is the next node, a leaf has none.
    struct Node
    {
        Vec3 low{0.0, 0.0, 0.0};
        Vec3 high{0.0, 0.0, 0.0};
        std::uint32_t right{0};
        std::uint32_t triangle{0};
    };

    void build(const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& order,
               std::uint32_t first, std::uint32_t count);

    [[nodiscard]] static double gap(const Node& a, const Node& b)
    {
        const Vec3 apart = (a.low - b.high).cwiseMax(b.low - a.high);
        return apart.cwiseMax(Vec3(0.0, 0.0, 0.0)).norm();
    }
    [[nodiscard]] static double size(const Node& node)
    {
        return node.right == 0 ? -1.0 : (node.high - node.low).squaredNorm();
    }

    template <typename Limit, typename Visit>
    static void visit_below(const TriangleTree& a, std::uint32_t i, const TriangleTree& b,
                            std::uint32_t j, const Limit& limit, const Visit& visit)
    {
        const Node& in_a = a.nodes_[i];
        const Node& in_b = b.nodes_[j];
        if (gap(in_a, in_b) > limit())
        {
            return;
        }
        if (in_a.right == 0 && in_b.right == 0)
        {
            visit(in_a.triangle, in_b.triangle);
        }
        else if (size(in_a) >= size(in_b))
        {
            const bool is_right_nearer =
                gap(a.nodes_[in_a.right], in_b) < gap(a.nodes_[i + 1], in_b);
            visit_below(a, is_right_nearer ? in_a.right : i + 1, b, j, limit, visit);
            visit_below(a, is_right_nearer ? i + 1 : in_a.right, b, j, limit, visit);
        }
        else
        {
            const bool is_right_nearer =
                gap(in_a, b.nodes_[in_b.right]) < gap(in_a, b.nodes_[j + 1]);
            visit_below(a, i, b, is_right_nearer ? in_b.right : j + 1, limit, visit);
            visit_below(a, i, b, is_right_nearer ? j + 1 : in_b.right, limit, visit);
        }
    }

    std::vector<Node> nodes_;
};

} // namespace tactus::test
