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

/// A face of the tool's source and one of the object's.
struct FacePair
{
    std::uint32_t tool_face{0};
    std::uint32_t face{0};

    auto operator<=>(const FacePair&) const = default;
};

/// The truth about a tool that is a mesh and an object: every face of both sources.
///
/// What meets is decided exactly, with the tool's corners where the frame places them, in double:
/// the formula here is the frame's, and nothing else is. Distances are those of the tool where it
/// ought to be, in extended precision, of corners from triangles and of edges.
class MeshPairOracle
{
public:
    /// Both must outlive the oracle.
    MeshPairOracle(const TestModel& tool, const TestModel& object);

    /// Everything below is about these places; about a millisecond for 4,000 faces.
    void place(const ObjectPose& pose, const ToolState& tool);

    struct Nearest
    {
        long double distance_m{0}; ///< In the world.
        FacePair faces;
    };
    /// The nearest pair; 0 where faces meet.
    [[nodiscard]] Nearest nearest();
    /// In ascending order.
    [[nodiscard]] std::vector<FacePair> meeting() const;
    /// Pairs of this distance at most, in the world; not many more than `enough`, if there are.
    [[nodiscard]] std::vector<FacePair> within(double distance_m, std::size_t enough) const;

    [[nodiscard]] bool do_meet(const FacePair& faces) const;
    /// Of one pair, in the world.
    template <typename Real = long double>
    [[nodiscard]] Real distance(const FacePair& faces) const;

private:
    using WidePoint = Point<long double>;
    using WideTriangle = std::array<WidePoint, 3>;

    [[nodiscard]] WideTriangle ideal_tool_face(std::uint32_t face) const;
    /// What two faces are apart at least along three directions, in the object's frame; cheap.
    [[nodiscard]] double gap_m(const FacePair& faces) const;

    const TestModel& tool_;
    std::vector<Triangle> tool_faces_;   ///< In the tool's frame, but for the origin.
    std::vector<Triangle> placed_faces_; ///< In the object's model's frame.
    std::vector<Triangle> object_faces_;
    std::vector<Vec3> tool_normals_; ///< In the tool's frame; of about unit length, or zero.
    std::vector<Vec3> normals_;
    Mat3 rotation_{Mat3::Identity()}; ///< Of the tool's frame in the object's.
    TriangleTree tool_tree_;
    TriangleTree object_tree_;
    Vec3 origin_m_; ///< Of the tool's model in the tool's frame.

    /// The way of a point of the tool's frame, with no rounding that counts.
    std::array<WidePoint, 3> wide_rows_{};
    WidePoint wide_origin_{};
    double scale_{1.0};
    double margin_m_{0.0}; ///< Above what placed corners are off by, in the object's frame.
    FacePair last_nearest_;
};

} // namespace tactus::test
