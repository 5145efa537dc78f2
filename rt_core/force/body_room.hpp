// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/math/vec3.hpp"

#include <span>

namespace tactus
{

/// A body's way in one step: the centre of its core's ball goes straight while it turns round one
/// axis. World frame.
struct BodyWay
{
    Vec3 center_m{0.0, 0.0, 0.0}; ///< Of the centre.
    Vec3 turn_rad{0.0, 0.0, 0.0}; ///< A rotation vector, about the centre.
    double core_radius_m{0.0};    ///< Of the ball.

    /// No point of the core goes farther: chords are shorter than arcs.
    [[nodiscard]] double length_m() const noexcept
    {
        return center_m.norm() + turn_rad.norm() * core_radius_m;
    }
    /// No point of the core comes nearer, by more than this, to what lies behind a plane of this
    /// normal, or of one within `spread` of it. A turn R changes normal . (R - 1) q by no more than
    /// |q| x |(R^T - 1) normal|, and that by no more than |turn x normal|.
    [[nodiscard]] double approach_m(const Vec3& normal, double spread) const noexcept
    {
        const double straight_m =
            core_radius_m * turn_rad.cross(normal).norm() - normal.dot(center_m);
        const double length = length_m();
        return spread > 0.0 ? straight_m + spread * length : straight_m;
    }
};

/// How far a body may go in one step so that its core never meets a surface, over the whole way.
///
/// Two proofs, of which the better one counts. No surface is nearer than L, so no way that is
/// shorter meets one. And where all faces near are exact, each lies behind a plane that the core is
/// before (ContactSlab): a way along those planes may be as long as everything within it is known.
/// A share of each distance is never gone, and of the radius half is kept, so that there is room to
/// come back. A turn is kept shorter than L in any case: a body that rocks on points that it learns
/// of one by one would forget those that it turns away from.
///
/// Haptic thread; refers to `surfaces`.
class BodyRoom
{
public:
    /// From everything but the surfaces the core is at least `clear_m` away.
    BodyRoom(std::span<const PlacedSurface> surfaces, double clear_m,
             double radius_m) noexcept TACTUS_NONBLOCKING;

    /// Some way is free.
    [[nodiscard]] bool is_free() const noexcept { return free_m_ > 0.0; }
    /// The core is proven to touch nothing.
    [[nodiscard]] bool is_clear() const noexcept { return is_clear_; }
    /// The core is known to touch something.
    [[nodiscard]] bool is_crossed() const noexcept { return is_crossed_; }
    /// The core is known to be so near to something that all but the last tenth of the radius is
    /// used up.
    [[nodiscard]] bool is_scarce() const noexcept { return is_scarce_; }

    /// The share of the way that is proven free, 0 .. 1.
    [[nodiscard]] double share_of(const BodyWay& way) const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] double free_of(const PlacedSurface& placed) const noexcept;
    [[nodiscard]] double share_of(const BodyWay& way, const PlacedSurface& placed) const noexcept;

    std::span<const PlacedSurface> surfaces_;
    double radius_m_;
    double elsewhere_m_; ///< Free of what is no surface here.
    double free_m_;
    bool is_clear_;
    bool is_crossed_{false};
    bool is_scarce_{false};
};

} // namespace tactus
