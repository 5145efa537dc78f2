// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/shared/closest_point.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/shared/triangle_tree.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace tactus::test
{

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
