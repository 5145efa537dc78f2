// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <span>
#include <utility>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Largest error of a support point, in radii of the body: its distance outside of the body, and
/// its shortfall against the farthest point. Nine roundings, enough to rotate a direction into the
/// body's frame and the point back.
inline constexpr double kSupportError = 1e-15;

/// Convex and closed body, defined by its farthest point in each direction. Lengths have any one
/// unit; metres if the body is a tool's core.
struct ConvexBody
{
    /// Returns a farthest point of the body in a direction, relative to `center`, so that the
    /// body's position causes no rounding. The direction has length 1 within a few roundings. Equal
    /// directions must give equal points.
    using Support = Vec3 (*)(const void* context,
                             const Vec3& direction) noexcept TACTUS_NONBLOCKING;

    Support support{nullptr};     ///< Not null; called on the haptic thread for a tool's body.
    const void* context{nullptr}; ///< Argument for `support`; must outlive the body.
    Vec3 center{0.0, 0.0, 0.0};   ///< Centre of the body, well inside if it has an inside.
    double radius{0.0};           ///< Radius of a sphere round the centre that holds the body.
};

enum class HullError : std::uint8_t
{
    no_vertex,
    too_many_vertices, ///< More than kMaxHullVertices.
    vertex_not_finite, ///< A coordinate is not finite, or beyond kCoordinateRange.
};

/// Convex hull of vertices; it may be a point, a segment or a polygon, and vertices may lie inside
/// of it. The vertices remain the caller's and must outlive the hull.
class Hull
{
public:
    [[nodiscard]] static Result<Hull, HullError>
    create(std::span<const Vec3> vertices) noexcept TACTUS_NONBLOCKING;

    /// Returns a view of this hull, which must not move. The first one of equally far vertices is
    /// the support point.
    [[nodiscard]] ConvexBody body() const noexcept { return {&support, this, center_, radius_}; }

    [[nodiscard]] std::span<const Vec3> vertices() const noexcept { return vertices_; }

private:
    Hull(std::span<const Vec3> vertices, Vec3 center, double radius) noexcept
        : vertices_(vertices), center_(std::move(center)), radius_(radius)
    {
    }

    static Vec3 support(const void* hull, const Vec3& direction) noexcept TACTUS_NONBLOCKING;

    std::span<const Vec3> vertices_;
    Vec3 center_; ///< Mean of the vertices.
    double radius_;
};

} // namespace tactus
