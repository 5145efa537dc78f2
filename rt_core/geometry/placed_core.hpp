// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/gjk.hpp"
#include "rt_core/geometry/shapes.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

#include <array>
#include <cstdint>
#include <tuple>

namespace tactus
{

/// Spheres that together hold a core. Their order and number don't change when it moves.
using CoreCover = StaticVector<Sphere, kMaxCoverSpheres>;

/// Corners of a core that is a segment, a box or a hull; other cores have none.
using CoreCorners = StaticVector<Vec3, kMaxHullVertices>;

/// Cheap bounds on the distance of a core and a triangle.
struct CoreBounds
{
    double lower{0.0};       ///< Lower bound; may be negative.
    double upper{kInfinity}; ///< Distance to a corner of the triangle.
    bool meet{false};        ///< Proven to meet; PlacedCore::closest() then agrees.
};

/// Direction that separates a core and a triangle.
struct CoreSeparation
{
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the triangle to the core.
    double distance{0.0};       ///< Lower bound of the distance along it; may be negative.
};

/// One coordinate of corners shared by triangles.
using CornerRow = std::array<float, 16>;

/// Corners of triangles in the frame of the oriented box of a core. 512 B.
struct CornersAtCore
{
    static constexpr std::size_t kCorners = std::tuple_size_v<CornerRow>;
    using Row = std::array<double, kCorners>;

    std::array<Row, 3> place;
    Row beyond_sq; ///< Squared distances from that box.
};

/// A tool's core in a model's frame, in which distances are measured. Results take its placed
/// coordinates, which are rounded once, as exact. A mesh is represented only by its oriented box.
/// 0.2 KiB.
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
    [[nodiscard]] bool is_box() const noexcept
    {
        return std::holds_alternative<Box>(core_) && !is_mesh_;
    }
    [[nodiscard]] bool is_convex_body() const noexcept
    {
        return std::holds_alternative<Hull>(core_) || std::holds_alternative<ConvexBody>(core_);
    }
    /// The placed core as a convex body, for cores that are one. Points at this object, which must
    /// not move meanwhile.
    [[nodiscard]] ConvexBody body() const noexcept TACTUS_NONBLOCKING;

    /// Centre and radius of a sphere that holds the core; for a point, the point.
    [[nodiscard]] const Vec3& center() const noexcept { return center_; }
    [[nodiscard]] double radius() const noexcept { return radius_; }

    /// Oriented box of the core, with the same centre: unit axes as columns, half extents.
    [[nodiscard]] const Mat3& axes() const noexcept { return axes_; }
    [[nodiscard]] const Vec3& half() const noexcept { return half_; }

    /// Distance and nearest points of core and triangle; the same bits regardless of other calls.
    /// For a convex body `meet` is true only if proven. Not for a mesh (query_meshes). 50 ns for a
    /// point to about 2 us for a box or convex body.
    [[nodiscard]] ClosestPoints closest(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Bounds from the oriented box of the core; a segment and a box equal theirs, so bounds are
    /// tight to rounding if a corner of the triangle is nearest. A convex body has no upper bound.
    /// About 40 ns.
    [[nodiscard]] CoreBounds bounds(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    /// The same for triangles that share corners, about 20 ns each plus 100 for the corners. Lower
    /// bounds above `limit` need not be tight.
    void see(const std::array<CornerRow, 3>& corners,
             CornersAtCore& seen) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] CoreBounds bounds(const CornersAtCore& seen,
                                    const std::array<std::uint8_t, 3>& triangle,
                                    double limit) const noexcept TACTUS_NONBLOCKING;

    /// Separation along the vector from the core's oriented box to the nearest corner; its normal
    /// is zero if that corner is in the box. About 30 ns.
    [[nodiscard]] CoreSeparation
    separation(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Enough spheres for none to be larger than `enough`, but at most kMaxCoverSpheres.
    [[nodiscard]] CoreCover cover(double enough) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] CoreCorners corners() const noexcept TACTUS_NONBLOCKING;

    /// Largest displacement of the core's points since `before`, which is the same core placed
    /// elsewhere.
    [[nodiscard]] double motion_since(const PlacedCore& before) const noexcept TACTUS_NONBLOCKING;

private:
    void surround(const ConvexBody& body, const Similarity& place) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ConvexBody own_body() const noexcept TACTUS_NONBLOCKING;
    static Vec3 placed_support(const void* core, const Vec3& direction) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ClosestPoints
    closest_to_box(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    /// Triangle in the frame of the oriented box; below, a bound on the rounding.
    [[nodiscard]] Triangle to_box_frame(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] double
    rounding_of(const Triangle& in_box_frame) const noexcept TACTUS_NONBLOCKING;
    /// Bounds for a triangle in that frame with these squared distances of its corners from the
    /// box.
    [[nodiscard]] CoreBounds bounds(const Triangle& near, const std::array<double, 3>& beyond_sq,
                                    double limit) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] double apart_along(const Vec3& way,
                                     const Triangle& near) const noexcept TACTUS_NONBLOCKING;

    /// A segment is placed; a box has its placed half extents, as has the box of a mesh; convex
    /// bodies are as given. Five alternatives are the most that are copied without a call through a
    /// pointer.
    std::variant<PointCore, Segment, Box, Hull, ConvexBody> core_;
    bool is_mesh_{false};
    Vec3 center_{0.0, 0.0, 0.0};
    double radius_{0.0};
    Mat3 axes_{Mat3::Identity()};
    Vec3 half_{0.0, 0.0, 0.0};
    double scale_{1.0};
};

/// Heights of corners along an axis of length 1, from a centre.
[[nodiscard]] CornersAtCore::Row heights_along(const Vec3& axis,
                                               const std::array<CornerRow, 3>& corners,
                                               const Vec3& center) noexcept TACTUS_NONBLOCKING;

/// The middle of both bounds, with half of their difference as the error.
[[nodiscard]] ClosestPoints to_closest_points(const GjkAnswer& answer) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
