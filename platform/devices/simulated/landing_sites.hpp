// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus
{

/// A place on a model that can be reached from outside without an obstacle on the way.
struct LandingSite
{
    Vec3 aim_world_m;      ///< On or just below the surface.
    Vec3 gate_world_m;     ///< Outside; the straight way from here to the aim is free.
    double orbit_radius_m; ///< The gate's distance from the box centre: a sphere round the model.
};

/// The centre of the anchors' bounding box.
[[nodiscard]] Vec3 centre_of(std::span<const Vec3> anchors_world_m) noexcept;

/// Sites to try, best first; never empty for at least one finite anchor.
///
/// An anchor that is extreme in a direction d has the whole model on one side of its plane, so
/// everything on the other side is free; a gate above that plane and a straight way down are safe.
/// The directions are those of the axes, the box's shortest first: there the widest faces look out,
/// with the most room to slide. `turned` hands before this one took those that it begins behind,
/// going round. Extreme anchors tend to be corners, so a first try aims a twentieth
/// of the diagonal further in, which may miss a thin model; the anchor itself follows.
[[nodiscard]] std::vector<LandingSite> find_landing_sites(std::span<const Vec3> anchors_world_m,
                                                          double diagonal_m, double tool_radius_m,
                                                          std::size_t turned = 0);

} // namespace tactus
