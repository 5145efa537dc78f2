// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/model.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/records/frame_input.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/closest_point.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/test_model.hpp"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace tactus::test
{

/// Faces of a model identified by position in the source, whose order is not that of FaceIds. Faces
/// with the same three corners share a name, the lowest of their places.
class FaceNames
{
public:
    explicit FaceNames(const std::vector<Face>& faces);

    /// Name of a face of the source.
    [[nodiscard]] std::uint32_t of(std::uint32_t source) const { return names_[source]; }
    /// Name of an active face; empty if it is not active or not a face of the source.
    [[nodiscard]] std::optional<std::uint32_t> of(const Model& model, FaceId face) const;

private:
    std::map<Face, std::uint32_t> by_corners_; ///< Names by corners in ascending order.
    std::vector<std::uint32_t> names_;
};

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

/// Face of the tool's source and face of the object's.
struct FacePair
{
    std::uint32_t tool_face{0};
    std::uint32_t face{0};

    auto operator<=>(const FacePair&) const = default;
};

/// Truth about a mesh tool and an object, from every face of both sources.
///
/// Meeting is decided exactly, with the tool's corners at the frame's placement in double: this
/// formula is the frame's, and nothing else is. Distances are those of the exact placement, in
/// extended precision, between corners and triangles and between edges.
class MeshPairOracle
{
public:
    /// Prepares both models, which must outlive the oracle.
    MeshPairOracle(const TestModel& tool, const TestModel& object);

    /// Sets the poses of all questions below; about a millisecond for 4,000 faces.
    void place(const ObjectPose& pose, const ToolState& tool);

    struct Nearest
    {
        long double distance_m{0}; ///< Distance in the world.
        FacePair faces;
    };
    /// Nearest pair; 0 if faces meet.
    [[nodiscard]] Nearest nearest();
    /// Meeting pairs in ascending order.
    [[nodiscard]] std::vector<FacePair> meeting() const;
    /// Pairs within this distance in the world; stops soon after `enough`.
    [[nodiscard]] std::vector<FacePair> within(double distance_m, std::size_t enough) const;

    [[nodiscard]] bool do_meet(const FacePair& faces) const;
    template <typename Real = long double>
    [[nodiscard]] Real distance(const FacePair& faces) const;

private:
    using WidePoint = Point<long double>;
    using WideTriangle = std::array<WidePoint, 3>;

    [[nodiscard]] WideTriangle ideal_tool_face(std::uint32_t face) const;
    /// Lower bound of the distance of two faces from three directions, in the object's frame;
    /// cheap.
    [[nodiscard]] double gap_m(const FacePair& faces) const;

    const TestModel& tool_;
    std::vector<Triangle> tool_faces_;   ///< Faces in the tool frame, without the origin.
    std::vector<Triangle> placed_faces_; ///< Faces in the object's model frame.
    std::vector<Triangle> object_faces_;
    std::vector<Vec3> tool_normals_; ///< Normals in the tool frame; of about unit length, or zero.
    std::vector<Vec3> normals_;
    Mat3 rotation_{Mat3::Identity()}; ///< Rotation of the tool frame in the object's.
    TriangleTree tool_tree_;
    TriangleTree object_tree_;
    Vec3 origin_m_; ///< Origin of the tool's model in the tool frame.

    /// Transform of a point of the tool frame, without significant rounding.
    std::array<WidePoint, 3> wide_rows_{};
    WidePoint wide_origin_{};
    double scale_{1.0};
    double margin_m_{0.0}; ///< Bound of the error of placed corners, in the object's frame.
    FacePair last_nearest_;
};

} // namespace tactus::test
