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

/// Spheres that together hold a core. Their order and number don't change when the core moves.
using CoreCover = StaticVector<Sphere, kMaxCoverSpheres>;

/// Corners of a core that is a segment, a box or a hull; other cores have none.
using CoreCorners = StaticVector<Vec3, kMaxHullVertices>;

/// Cheap bounds on the distance of a core and a triangle.
struct CoreBounds
{
    double lower{0.0};       ///< Lower bound; may be negative.
    double upper{kInfinity}; ///< Upper bound: the distance of a corner of the triangle.
    /// True if core and triangle are proven to meet; PlacedCore::closest() then agrees.
    bool meet{false};
};

/// Direction that separates a core and a triangle.
struct CoreSeparation
{
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the triangle to the core.
    double distance{0.0};       ///< Lower bound on the distance along `normal`; may be negative.
};

/// One coordinate of each corner in a list that several triangles share.
using CornerRow = std::array<float, 16>;

/// Corners that several triangles share, in the frame of the oriented box of a core. 512 B.
struct CornersAtCore
{
    static constexpr std::size_t kCorners = std::tuple_size_v<CornerRow>;
    using Row = std::array<double, kCorners>;

    std::array<Row, 3> place;
    Row beyond_sq; ///< Squared distances of the corners from that box.
};

/// Core of a tool, placed in a model's frame, in which distances are measured. Placed coordinates
/// are rounded once and then count as exact. A mesh is represented only by its oriented box. 0.2
/// KiB.
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
    /// The placed core as a convex body; only for cores that are one. The result refers to this
    /// object, which must not move meanwhile.
    [[nodiscard]] ConvexBody body() const noexcept TACTUS_NONBLOCKING;

    /// Centre and radius of the core's bounding sphere; for a point the point and 0.
    [[nodiscard]] const Vec3& center() const noexcept { return center_; }
    [[nodiscard]] double radius() const noexcept { return radius_; }

    /// Oriented bounding box of the core, round center(): axes() has the unit axes as columns,
    /// half() the half extents.
    [[nodiscard]] const Mat3& axes() const noexcept { return axes_; }
    [[nodiscard]] const Vec3& half() const noexcept { return half_; }

    /// Distance and nearest points of core and triangle; the same arguments give the same bits.
    /// `meet` of a convex body is true only if proven. Not for a mesh (query_meshes()). 50 ns for a
    /// point to about 2 us for a box or convex body.
    [[nodiscard]] ClosestPoints closest(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Bounds on the distance from the core's oriented box. A segment and a box equal their boxes,
    /// so their bounds are tight to rounding if a corner of the triangle is nearest. A convex body
    /// has no upper bound. About 40 ns.
    [[nodiscard]] CoreBounds bounds(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    /// measure_corners() and this bounds() do the same for triangles that share corners, in about
    /// 20 ns each plus 100 for the corners. Lower bounds above `limit` need not be tight.
    void measure_corners(const std::array<CornerRow, 3>& corners,
                         CornersAtCore& seen) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] CoreBounds bounds(const CornersAtCore& seen,
                                    const std::array<std::uint8_t, 3>& triangle,
                                    double limit) const noexcept TACTUS_NONBLOCKING;

    /// Separation of core and triangle along the vector from the core's oriented box to the nearest
    /// corner; the normal is zero if that corner is in the box. About 30 ns.
    [[nodiscard]] CoreSeparation
    separation(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// Spheres that hold the core: enough that none has a radius above `enough`, but at most
    /// kMaxCoverSpheres.
    [[nodiscard]] CoreCover cover(double enough) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] CoreCorners corners() const noexcept TACTUS_NONBLOCKING;

    /// Bound on the displacement of the core's points since `before`, the same core placed
    /// elsewhere.
    [[nodiscard]] double motion_since(const PlacedCore& before) const noexcept TACTUS_NONBLOCKING;

private:
    void surround(const ConvexBody& body, const Similarity& place) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ConvexBody own_body() const noexcept TACTUS_NONBLOCKING;
    static Vec3 placed_support(const void* core, const Vec3& direction) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ClosestPoints
    closest_to_box(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    /// Converts a triangle to the frame of the oriented box; rounding_of() bounds the rounding.
    [[nodiscard]] Triangle to_box_frame(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] double
    rounding_of(const Triangle& in_box_frame) const noexcept TACTUS_NONBLOCKING;
    /// Bounds for a triangle in the box's frame; `beyond_sq` are its corners' squared distances
    /// from the box.
    [[nodiscard]] CoreBounds bounds(const Triangle& near, const std::array<double, 3>& beyond_sq,
                                    double limit) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] double apart_along(const Vec3& way,
                                     const Triangle& near) const noexcept TACTUS_NONBLOCKING;

    /// Core of the tool: a segment is placed, a box (also that of a mesh) has placed half extents,
    /// and convex bodies are as given. More than five alternatives would be copied by a call
    /// through a pointer.
    std::variant<PointCore, Segment, Box, Hull, ConvexBody> core_;
    bool is_mesh_{false};
    Vec3 center_{0.0, 0.0, 0.0};
    double radius_{0.0};
    Mat3 axes_{Mat3::Identity()};
    Vec3 half_{0.0, 0.0, 0.0};
    double scale_{1.0};
};

/// Heights of the corners along an axis of length 1, relative to a centre.
[[nodiscard]] CornersAtCore::Row heights_along(const Vec3& axis,
                                               const std::array<CornerRow, 3>& corners,
                                               const Vec3& center) noexcept TACTUS_NONBLOCKING;

/// Converts the bounds: the distance is their middle, the error half of their difference.
[[nodiscard]] ClosestPoints to_closest_points(const GjkAnswer& answer) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
