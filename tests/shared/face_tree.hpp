// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/closest_point.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tactus::test
{

/// Plain binary box tree over all faces of a mesh, in double precision, for motions and true
/// distances. Shares no code with the tested or measured code.
class FaceTree
{
public:
    struct Nearest
    {
        double distance_m{std::numeric_limits<double>::infinity()};
        Vec3 point_m{0.0, 0.0, 0.0};
        std::uint32_t face{0};
    };

    struct WideNearest
    {
        long double distance_m{std::numeric_limits<long double>::infinity()};
        std::uint32_t face{0};
    };

    /// Builds over `faces`, at least one, with `bounds_m`, one for each face or none; both must
    /// outlive the tree. n log n; 4 M faces take some seconds.
    explicit FaceTree(const std::vector<Face>& faces, std::span<const double> bounds_m = {});

    [[nodiscard]] Nearest nearest(const Vec3& point_m) const;
    /// Least distance - bound over the faces, or the first value found that is at most `enough_m`.
    [[nodiscard]] double least_excess(const Vec3& point_m, double enough_m) const;

    /// Distance in extended precision by DistanceOracle, also right for needles: a box is skipped
    /// only if it is farther by more than the rounding of double precision.
    [[nodiscard]] WideNearest wide_nearest(const Point<long double>& point_m) const;

    /// Ids of faces, including all whose boxes meet this closed box; at most a leaf too many.
    [[nodiscard]] std::vector<std::uint32_t> faces_near_box(const Vec3& low_m,
                                                            const Vec3& high_m) const;

    [[nodiscard]] Vec3 low_m() const { return nodes_.front().low; }
    [[nodiscard]] Vec3 high_m() const { return nodes_.front().high; }

private:
    static constexpr std::uint32_t kLeafFaces = 8;

    /// Node; a leaf if `right` is 0. The left child of an inner node is the next node.
    struct Node
    {
        Vec3 low{0.0, 0.0, 0.0};
        Vec3 high{0.0, 0.0, 0.0};
        double bound{0.0}; ///< Greatest bound of its faces.
        std::uint32_t right{0};
        std::uint32_t first{0};
        std::uint32_t count{0};
    };
    /// Search for the least distance, or distance - bound; it ends as soon as that is `enough`.
    struct Search
    {
        Vec3 point_m;
        bool subtracts_bounds{false};
        double enough{-std::numeric_limits<double>::infinity()};
        double least{std::numeric_limits<double>::infinity()};
        Nearest best{};
    };

    void build(std::uint32_t first, std::uint32_t count);
    void find_box(Node& node) const;
    void search(std::uint32_t index, Search& sought) const;
    void search_wide(std::uint32_t index, const Point<long double>& point_m, const Search& sought,
                     WideNearest& best) const;
    void collect(std::uint32_t index, const Vec3& low_m, const Vec3& high_m,
                 std::vector<std::uint32_t>& found) const;
    void search_leaf(const Node& node, Search& sought) const;
    [[nodiscard]] double lower_bound(std::uint32_t index, const Search& sought) const;
    [[nodiscard]] double bound_of(std::uint32_t face) const
    {
        return bounds_m_.empty() ? 0.0 : bounds_m_[face];
    }

    const std::vector<Face>& faces_;
    std::span<const double> bounds_m_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace tactus::test
