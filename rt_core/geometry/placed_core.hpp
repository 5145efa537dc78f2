// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/gjk.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/limits.hpp"

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

    /// Distance and nearest points of core and triangle, the same bits whatever else is asked. Of
    /// a convex body `meet` says what is proven. Not for a mesh (query_meshes). 50 ns for a point
    /// to some 2 us for a box or body.
    [[nodiscard]] ClosestPoints closest(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

    /// The triangle is at least this far away; about 20 ns. Good to the corners of the oriented box
    /// round the core.
    [[nodiscard]] double lower_bound(const Triangle& triangle) const noexcept TACTUS_NONBLOCKING;

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

    /// A segment is placed; a box has its placed half extents, as has what stands for a mesh;
    /// bodies are as given. Five are as many as are copied without a call through a pointer.
    std::variant<PointCore, Segment, Box, Hull, ConvexBody> core_;
    bool is_mesh_{false};
    Vec3 center_{0.0, 0.0, 0.0};
    double radius_{0.0};
    // An oriented box round the core: centre, unit axes as columns, half extents.
    Mat3 axes_{Mat3::Identity()};
    Vec3 half_{0.0, 0.0, 0.0};
    double scale_{1.0};
};

/// The middle of both bounds, its error half of what is between them.
[[nodiscard]] ClosestPoints to_closest_points(const GjkAnswer& answer) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
