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

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// What a support point may be off, in radii: how far outside of the body it lies, and how much
/// less far it reaches than the farthest. Nine roundings: enough to turn a direction into the
/// body's frame and the point back.
inline constexpr double kSupportError = 1e-15;

/// A convex and closed body, known by its farthest points. Lengths have any one unit: metres where
/// it is a tool's core.
struct ConvexBody
{
    /// A point of the body than which none is farther in a direction, relative to `center`: so
    /// where the body is rounds nothing. The direction's length is 1 within a few roundings. Equal
    /// directions are to give equal points.
    using Support = Vec3 (*)(const void* context,
                             const Vec3& direction) noexcept TACTUS_NONBLOCKING;

    Support support{nullptr};     ///< Not null; on the haptic thread where the body is a tool's.
    const void* context{nullptr}; ///< Handed to `support`; outlives the body.
    Vec3 center{0.0, 0.0, 0.0};   ///< Of the body, and well inside where it has an inside.
    double radius{0.0};           ///< Of a ball round the centre that holds the body.
};

enum class HullError : std::uint8_t
{
    no_vertex,
    too_many_vertices, ///< More than kMaxHullVertices.
    vertex_not_finite, ///< Or beyond kCoordinateRange.
};

/// The convex hull of vertices, which may be a point, a segment or a polygon; vertices inside of it
/// are allowed. The vertices stay the caller's and are to outlive the hull.
class Hull
{
public:
    [[nodiscard]] static Result<Hull, HullError>
    create(std::span<const Vec3> vertices) noexcept TACTUS_NONBLOCKING;

    /// Points at this hull, which is to stay where it is. Of vertices that are as far the first is
    /// the farthest.
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
