// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::bench
{

/// A plain binary box tree over all faces of a mesh, in double precision: makes the motions and
/// knows the true distances without any code of what is measured.
class FaceTree
{
public:
    struct Nearest
    {
        double distance_m{0.0};
        Vec3 point_m{0.0, 0.0, 0.0};
    };

    /// `faces`, at least one, must outlive the tree. n log n; 4 M faces take some seconds.
    explicit FaceTree(const std::vector<test::Face>& faces);

    [[nodiscard]] Nearest nearest(const Vec3& point_m) const;
    [[nodiscard]] Vec3 low_m() const { return nodes_.front().low; }
    [[nodiscard]] Vec3 high_m() const { return nodes_.front().high; }

private:
    static constexpr std::uint32_t kLeafFaces = 8;

    /// A leaf when `right` is 0; its left child is otherwise the next node.
    struct Node
    {
        Vec3 low{0.0, 0.0, 0.0};
        Vec3 high{0.0, 0.0, 0.0};
        std::uint32_t right{0};
        std::uint32_t first{0};
        std::uint32_t count{0};
    };

    void build(std::uint32_t first, std::uint32_t count);
    void search(std::uint32_t index, const Vec3& point_m, Nearest& best) const;
    [[nodiscard]] double box_distance(std::uint32_t index, const Vec3& point_m) const;

    const std::vector<test::Face>& faces_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace tactus::bench
