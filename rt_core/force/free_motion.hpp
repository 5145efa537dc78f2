// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/math/vec3.hpp"

#include <span>

namespace tactus
{

/// Motion of a rigid tool in one step: the centre of the core's bounding sphere moves straight
/// while the tool rotates about one axis. World frame.
struct RigidWay
{
    Vec3 center_m{0.0, 0.0, 0.0};     ///< Displacement of the centre.
    Vec3 rotation_rad{0.0, 0.0, 0.0}; ///< Rotation vector, about the centre.
    double core_radius_m{0.0};        ///< Radius of the core's bounding sphere.

    /// Bound on the displacement of the core's points during the motion.
    [[nodiscard]] double length_m() const noexcept
    {
        return center_m.norm() + rotation_rad.norm() * core_radius_m;
    }
    /// Bound on the approach of the core's points to a plane whose normal is within `spread` of
    /// `normal`. A rotation R changes normal . (R - 1) q by at most |q| x |(R^T - 1) normal|, which
    /// is at most |q| x |rotation_rad x normal|.
    [[nodiscard]] double approach_m(const Vec3& normal, double spread) const noexcept
    {
        const double straight_m =
            core_radius_m * rotation_rad.cross(normal).norm() - normal.dot(center_m);
        const double length = length_m();
        return spread > 0.0 ? straight_m + spread * length : straight_m;
    }
};

/// Largest share of a rigid tool's motion in one step for which its core provably never meets a
/// surface.
///
/// Two proofs exist, and the better one counts. No surface is nearer than L, so no shorter motion
/// meets one. If all near faces are exact, each lies behind a plane with the core in front
/// (ContactSlab). A motion along those planes may be as long as the known range. A part of each
/// distance and half of the radius are kept unused, as room to come back. A rotation is always kept
/// shorter than L: a tool that rocks on contacts found one by one would lose those that it rotates
/// away from.
///
/// Haptic thread. `surfaces` must outlive this object.
class FreeMotion
{
public:
    /// Free motion of a core that is at least `clear_m` away from everything that is not in
    /// `surfaces`.
    FreeMotion(std::span<const PlacedSurface> surfaces, double clear_m,
               double radius_m) noexcept TACTUS_NONBLOCKING;

    /// True if some motion is free.
    [[nodiscard]] bool is_free() const noexcept { return free_m_ > 0.0; }
    /// True if the core is proven to touch nothing.
    [[nodiscard]] bool is_clear() const noexcept { return is_clear_; }
    /// True if the core is known to touch something.
    [[nodiscard]] bool is_crossed() const noexcept { return is_crossed_; }
    /// True if the core is known to be nearer to a surface than a tenth of the radius.
    [[nodiscard]] bool is_scarce() const noexcept { return is_scarce_; }

    /// Share of the motion that is proven free, 0 .. 1.
    [[nodiscard]] double share_of(const RigidWay& way) const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] double free_of(const PlacedSurface& placed) const noexcept;
    [[nodiscard]] double share_of(const RigidWay& way, const PlacedSurface& placed) const noexcept;

    std::span<const PlacedSurface> surfaces_;
    double radius_m_;
    double elsewhere_m_; ///< Free distance from everything that is not in `surfaces`.
    double free_m_;
    bool is_clear_;
    bool is_crossed_{false};
    bool is_scarce_{false};
};

} // namespace tactus
