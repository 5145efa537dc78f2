// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/exact_shapes.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Largest number of vertices of a hull that edits a surface. A sweep with more is refused.
inline constexpr std::size_t kMaxSweptVertices = 64;

enum class CutSense : std::uint8_t
{
    carve, ///< The region is taken from the solid.
    fill,  ///< The region is joined to the solid.
};

/// A convex tool that moves along a straight line without rotation: all points within the radius of
/// the core's hull. One point of core is a sphere, two are a capsule, 4 to kMaxSweptVertices are a
/// hull, whose radius is 0.
struct Sweep
{
    std::vector<Vec3> core_m; ///< In the tool's frame.
    double radius_m{0.0};
    Mat3 rotation{Mat3::Identity()}; ///< Tool's frame to source's frame.
    Vec3 from_m{0.0, 0.0, 0.0};      ///< Tool's origin at the start, in the source's frame.
    Vec3 to_m{0.0, 0.0, 0.0};        ///< Tool's origin at the end, in the source's frame.
};

/// Share of a round tool's radius within which its polyhedron lies round the tool's surface.
inline constexpr double kSweptRoundness = 1.0 / 64.0;

/// The grid of a model in its source's frame.
struct SurfaceGrid
{
    Vec3 origin_m{0.0, 0.0, 0.0};
    double quantum_m{1.0};

    [[nodiscard]] Vec3 to_quanta(const Vec3& source_m) const
    {
        return (source_m - origin_m) / quantum_m;
    }
};

/// Region of a sweep in quanta of the model's grid. A round tool's polyhedron contains the tool of
/// radius (1 - kSweptRoundness) x radius_m, and lies in that of (1 + kSweptRoundness) x radius_m;
/// a hull is itself. Both within kSweptShift_quanta, and except where it was withdrawn. With
/// merging and withdrawal, an edited surface lies within 3 x kSweptRoundness x radius_m + 8 quanta
/// of the tool's surface.
struct SweptRegion
{
    Polyhedron polyhedron;
    /// Distance by which merging may move the surface: half of kSweptRoundness x radius, at least
    /// one quantum.
    double slack_quanta{1.0};
};

/// Largest shift of a vertex of a region: vertices are moved by less than this at random, so that
/// no vertex of the region lies in the plane of a face, and none of the surface in that of a facet.
inline constexpr double kSweptShift_quanta = 1.0 / 256.0;

/// A vertex of a region that is nearer than slack_quanta + kSweptTouch_quanta to a face is moved by
/// kSweptMoveShare x slack_quanta + kSweptMove_quanta: past most faces that merging has moved, but
/// by less than the slack of all but the smallest tools, so that merging removes the steps that it
/// leaves.
inline constexpr double kSweptTouch_quanta = 1.5;
inline constexpr double kSweptMoveShare = 0.5;
inline constexpr double kSweptMove_quanta = 1.5;

/// Region of a sweep; `seed` chooses the shifts. Refused with one line: a core or radius that is
/// not as above, a value that is not finite, a place too far from the model, a rotation that is
/// none, and a tool thinner than two quanta.
[[nodiscard]] Result<SweptRegion, Refusal> swept_region(const Sweep& sweep, const SurfaceGrid& grid,
                                                        std::uint64_t seed);

/// Moves the region's facets that run along a face, by moving their vertices along the region's
/// normal: away from what an earlier sweep left there, or through a face that would remain as a
/// film. A vertex that is neither near a face nor in the air stays. `is_solid` tells whether a
/// point lies in the solid.
void withdraw_from(std::span<const Triangle> faces, CutSense sense,
                   const std::function<bool(const Vec3&)>& is_solid, SweptRegion& region);

} // namespace tactus
