// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus
{

/// A place on a model that is reached from outside without an obstacle.
struct LandingSite
{
    Vec3 aim_world_m;      ///< Point on or just below the surface.
    Vec3 gate_world_m;     ///< Point outside; the straight path to the aim is free.
    double orbit_radius_m; ///< Gate's distance from the box centre: a sphere around the model.
};

/// Centre of the anchors' bounding box.
[[nodiscard]] Vec3 centre_of(std::span<const Vec3> anchors_world_m) noexcept;

/// Sites to try, best first; never empty for at least one finite anchor.
///
/// An anchor that is extreme in a direction d has the whole model on one side of its plane, so the
/// other side is free; a gate above that plane and a straight descent are safe. The directions are
/// those of the axes, the box's shortest first: the widest faces, with the most room to slide.
/// `turned`: number of hands before this one; the order starts after their sites, cyclically.
/// Extreme anchors tend to be corners, so the first attempt aims a twentieth of the diagonal
/// inwards, which may miss a thin model; the anchor itself follows.
[[nodiscard]] std::vector<LandingSite> find_landing_sites(std::span<const Vec3> anchors_world_m,
                                                          double diagonal_m, double tool_radius_m,
                                                          std::size_t turned = 0);

} // namespace tactus
