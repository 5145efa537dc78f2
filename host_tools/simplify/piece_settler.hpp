// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/point_triangle.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "host_tools/simplify/triangle_cut.hpp"
#include "rt_core/base/static_vector.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// A part of an original triangle and the fan face that it is assigned to.
struct Assignment
{
    Part part;
    std::uint32_t place{0}; ///< Index of that face in the fan.
    double squared{0};      ///< Largest squared distance of a corner to that face.
};

/// Assigns the pieces of one star to its new faces and cuts them. No assignment does better than
/// the lower bound, the largest distance of a measured point to its nearest face. A piece whose
/// best face is nearly as good stays uncut; any other is cut along the new edges. Memory is reused
/// from star to star.
class PieceSettler
{
public:
    /// Starts a star: prepares the fan faces after the collapse. Between each two adjacent ones
    /// lies a cut plane: a half plane from the parent along their common edge that bisects the
    /// angle of their normals.
    void begin(const QuantisedMesh& mesh, const Star& star);

    /// Adds a corner of a piece; returns its index for Part::points.
    std::uint32_t add_point(const Vec3& point);

    /// Measures the corners added since begin() and computes the distance up to which a piece stays
    /// uncut, at least `floor_quanta`.
    void measure(double floor_quanta);

    /// Assigns a piece: returns its parts with their faces, or the piece itself if it stays uncut.
    /// The result is valid until the next call.
    [[nodiscard]] std::span<const Assignment> settle(const Part& piece, const QuantisedMesh& mesh,
                                                     std::uint32_t triangle);

private:
    void measure_new_points();
    [[nodiscard]] Assignment assign_to_best(const Part& part) const noexcept;
    void cut_open_parts(const CutPlane& plane, const TriangleFrame& frame);

    std::uint32_t fan_size_{0};
    std::array<DistanceTriangle, kMaxFanFaces> faces_;
    StaticVector<CutPlane, kMaxFanFaces> planes_;
    PointColumns points_;
    /// Squared distances of each face, by point.
    std::array<std::vector<double>, kMaxFanFaces> squared_;
    double accepted_{0}; ///< Squared distance up to which a piece stays uncut.
    std::vector<Assignment> settled_;
    std::vector<Assignment> open_; ///< Parts that the next plane may cut.
    std::vector<Assignment> next_open_;
};

} // namespace tactus
