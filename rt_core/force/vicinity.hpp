// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/local_surface.hpp"

#include <span>

namespace tactus
{

/// One object's surface near a tool, as the force stage sees it.
struct PlacedSurface
{
    const ObjectPose* pose{nullptr};
    const LocalSurface* surface{nullptr};
};

/// The nearest place of a surface; world frame.
struct NearestSurface
{
    double distance_m{0.0};
    Vec3 normal{0.0, 0.0, 0.0}; ///< Unit length, from the surface to the point.
};

/// The few triangles that a tool near one place can touch: the proxy tests these many times, the
/// whole local surface once.
class Vicinity
{
public:
    /// The triangles within `reach_m` of `center_m` (world). When more are in reach than fit,
    /// reach_m() is less than asked for. `is_query_center` says that the surfaces were queried
    /// here, so their distances need not be computed again.
    Vicinity(std::span<const PlacedSurface> surfaces, const Vec3& center_m, double reach_m,
             bool is_query_center) noexcept TACTUS_NONBLOCKING;

    /// Every triangle that isn't in the list is at least this far from the centre.
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }

    /// Of the listed triangles; infinitely far, with `fallback` for a normal, when there is none.
    [[nodiscard]] NearestSurface nearest(const Vec3& point_m,
                                         const Vec3& fallback) const noexcept TACTUS_NONBLOCKING;

private:
    struct Entry
    {
        const ObjectPose* pose{nullptr};
        const LocalTriangle* triangle{nullptr};
    };

    StaticVector<Entry, kMaxLocalTriangles> entries_;
    double reach_m_;
};

} // namespace tactus
