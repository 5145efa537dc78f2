// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/math/vec3.hpp"

#include <span>

namespace tactus
{

/// Motion of a rigid tool in one step: the centre of its core's sphere moves straight while the
/// tool rotates about one axis. World frame.
struct BodyWay
{
    Vec3 center_m{0.0, 0.0, 0.0}; ///< Displacement of the centre.
    Vec3 turn_rad{0.0, 0.0, 0.0}; ///< Rotation vector, about the centre.
    double core_radius_m{0.0};    ///< Radius of the sphere.

    /// Bound on the displacement of the core's points: chords are shorter than arcs.
    [[nodiscard]] double length_m() const noexcept
    {
        return center_m.norm() + turn_rad.norm() * core_radius_m;
    }
    /// Bound on the approach of the core's points to the space behind a plane with this normal, or
    /// with one within `spread` of it. A rotation R changes normal . (R - 1) q by no more than |q|
    /// x |(R^T - 1) normal|, and that by no more than |turn x normal|.
    [[nodiscard]] double approach_m(const Vec3& normal, double spread) const noexcept
    {
        const double straight_m =
            core_radius_m * turn_rad.cross(normal).norm() - normal.dot(center_m);
        const double length = length_m();
        return spread > 0.0 ? straight_m + spread * length : straight_m;
    }
};

/// Largest motion of a rigid tool in one step for which its core never meets a surface, at any time
/// of the step.
///
/// Two proofs, of which the better one counts. No surface is nearer than L, so no shorter motion
/// meets one. And if all near faces are exact, each lies behind a plane with the core in front of
/// it (ContactSlab): a motion along those planes may be as long as the range within which
/// everything is known. A share of each distance is never used, and half of the radius is kept, so
/// that there is room to come back. A rotation is kept shorter than L in any case: a tool that
/// rocks on points that it learns one by one would forget those that it rotates away from.
///
/// Haptic thread; keeps a reference to `surfaces`.
class BodyRoom
{
public:
    /// The core is at least `clear_m` away from everything except the surfaces.
    BodyRoom(std::span<const PlacedSurface> surfaces, double clear_m,
             double radius_m) noexcept TACTUS_NONBLOCKING;

    /// True if some motion is free.
    [[nodiscard]] bool is_free() const noexcept { return free_m_ > 0.0; }
    /// True if the core is proven to touch nothing.
    [[nodiscard]] bool is_clear() const noexcept { return is_clear_; }
    /// True if the core is known to touch something.
    [[nodiscard]] bool is_crossed() const noexcept { return is_crossed_; }
    /// True if the core is known to be so near to something that all except the last tenth of the
    /// radius is used up.
    [[nodiscard]] bool is_scarce() const noexcept { return is_scarce_; }

    /// Share of the motion that is proven free, 0 .. 1.
    [[nodiscard]] double share_of(const BodyWay& way) const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] double free_of(const PlacedSurface& placed) const noexcept;
    [[nodiscard]] double share_of(const BodyWay& way, const PlacedSurface& placed) const noexcept;

    std::span<const PlacedSurface> surfaces_;
    double radius_m_;
    double elsewhere_m_; ///< Free distance from everything except the surfaces.
    double free_m_;
    bool is_clear_;
    bool is_crossed_{false};
    bool is_scarce_{false};
};

} // namespace tactus
