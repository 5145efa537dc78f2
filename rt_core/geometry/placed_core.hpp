// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/gjk.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

#include <array>
#include <cstdint>
#include <tuple>

namespace tactus
{

struct Ball
{
    Vec3 center{0.0, 0.0, 0.0};
    double radius{0.0};
};

/// Balls that hold a core together. Their order and number don't change when it moves.
using CoreCover = StaticVector<Ball, kMaxCoverBalls>;

/// Corners of a core: of a segment, a box or a hull; other cores have none.
using CoreCorners = StaticVector<Vec3, kMaxHullVertices>;

/// What little work tells of the distance of a core and a triangle.
struct CoreBounds
{
    double lower{0.0};       ///< They are apart at least this; may be negative,
    double upper{kInfinity}; ///< and a corner of the triangle at most this.
    bool meet{false};        ///< Proven, and then PlacedCore::closest() says so, too.
};

/// A plane between a core and a triangle.
struct CoreSeparation
{
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the triangle to the core.
    double distance{0.0};       ///< They are apart at least this along it; may be negative.
};

/// One coordinate of corners that triangles share.
using CornerRow = std::array<float, 16>;

/// Corners of triangles in the frame of the oriented box round a core. 512 B.
struct CornersAtCore
{
    static constexpr std::size_t kCorners = std::tuple_size_v<CornerRow>;
    using Row = std::array<double, kCorners>;

    std::array<Row, 3> place;
    Row beyond_sq; ///< How far they are from that box, squared.
};

/// A tool's core in a model's frame, from where distances are measured. What is computed from it
/// takes its placed coordinates, which are rounded once, for exact. A mesh is here no more than the
/// oriented box round it. 0.2 KiB.
class PlacedCore
{
public:
    PlacedCore() noexcept = default;
    PlacedCore(const ToolCore& core, const Similarity& place) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool is_point() const noexcept
    {
        return std::holds_alternative<PointCore>(core_);
    }
    [[nodiscard]] bool is_mesh() const noexcept { return is_mesh_; }
    [[nodiscard]] bool is_convex_body() const noexcept
    {
        return std::holds_alternative<Hull>(core_) || std::holds_alternative<ConvexBody>(core_);
    }
    /// A core that is one, placed. Points at this, which is to stay where it is meanwhile.
    [[nodiscard]] ConvexBody body() const noexcept TACTUS_NONBLOCKING;

    /// Of a ball that holds the core; of a point, the point.
    [[nodiscard]] const Vec3& center() const noexcept { return center_; }
    [[nodiscard]] double radius() const noexcept { return radius_; }

    /// An oriented box round the core, and round its centre: unit axes as columns, half extents.
    [[nodiscard]] const Mat3& axes() const noexcept { return axes_; }
    [[nodiscard]] const Vec3& half() const noexcept { return half_; }

    /// Distance and nearest points of core and triangle, the same bits whatever else is asked. Of
    /// a convex body `meet` says what is proven. Not for a mesh (query_meshes). 50 ns for a point
    /// to some 2 us for a box or body.
    [[nodiscard]] ClosestPoints closest(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Of the oriented box round the core, which a segment and a box are: to rounding where a
    /// corner of the triangle is nearest. Of a convex body there is no upper bound. About 40 ns.
    [[nodiscard]] CoreBounds bounds(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    /// The same of triangles that share corners, some 20 ns each beside 100 for the corners. What
    /// is farther than `limit` is no more than that.
    void see(const std::array<CornerRow, 3>& corners,
             CornersAtCore& seen) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] CoreBounds bounds(const CornersAtCore& seen,
                                    const std::array<std::uint8_t, 3>& triangle,
                                    double limit) const noexcept TACTUS_NONBLOCKING;

    /// Across the way from the core's oriented box to the nearest corner; of normal zero where that
    /// is in the box. About 30 ns.
    [[nodiscard]] CoreSeparation
    separation(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// As many balls as needed for none to be larger than `enough`, but at most kMaxCoverBalls.
    [[nodiscard]] CoreCover cover(double enough) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] CoreCorners corners() const noexcept TACTUS_NONBLOCKING;

    /// No point of the core was farther from where it is now. For the same core placed elsewhere.
    [[nodiscard]] double motion_since(const PlacedCore& before) const noexcept TACTUS_NONBLOCKING;

private:
    void surround(const ConvexBody& body, const Similarity& place) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ConvexBody own_body() const noexcept TACTUS_NONBLOCKING;
    static Vec3 placed_support(const void* core, const Vec3& direction) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ClosestPoints
    closest_to_box(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    /// Into the frame of the oriented box, and by how much that rounds at most.
    [[nodiscard]] Triangle to_box_frame(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] double
    rounding_of(const Triangle& in_box_frame) const noexcept TACTUS_NONBLOCKING;
    /// Of a triangle in that frame whose corners are so far from the box.
    [[nodiscard]] CoreBounds bounds(const Triangle& near, const std::array<double, 3>& beyond_sq,
                                    double limit) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] double apart_along(const Vec3& way,
                                     const Triangle& near) const noexcept TACTUS_NONBLOCKING;

    /// A segment is placed; a box has its placed half extents, as has what stands for a mesh;
    /// bodies are as given. Five are as many as are copied without a call through a pointer.
    std::variant<PointCore, Segment, Box, Hull, ConvexBody> core_;
    bool is_mesh_{false};
    Vec3 center_{0.0, 0.0, 0.0};
    double radius_{0.0};
    Mat3 axes_{Mat3::Identity()};
    Vec3 half_{0.0, 0.0, 0.0};
    double scale_{1.0};
};

/// How far corners are along an axis of length 1, from a centre.
[[nodiscard]] CornersAtCore::Row heights_along(const Vec3& axis,
                                               const std::array<CornerRow, 3>& corners,
                                               const Vec3& center) noexcept TACTUS_NONBLOCKING;

/// The middle of both bounds, its error half of what is between them.
[[nodiscard]] ClosestPoints to_closest_points(const GjkAnswer& answer) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
