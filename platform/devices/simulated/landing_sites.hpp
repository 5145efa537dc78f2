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
    Vec3 gate_world_m;     ///< Point outside the model; the straight path to the aim is free.
    double orbit_radius_m; ///< Distance of the gate from the centre of the model's box.
};

/// Centre of the anchors' bounding box.
[[nodiscard]] Vec3 centre_of(std::span<const Vec3> anchors_world_m) noexcept;

/// Sites to try, best first; never empty for at least one finite anchor.
///
/// The whole model is on one side of the plane through its extreme anchor in a direction. So a gate
/// on the other side and a straight descent are free. The directions are those of the axes, both
/// ways. The shortest axis of the box comes first, since its faces are the widest and leave the
/// most room to slide. Extreme anchors tend to be corners. So the first site of an anchor aims a
/// twentieth of the diagonal inwards, which may miss a thin model; the second site aims at the
/// anchor. `turned`: number of earlier hands on the model; their sites, two each, move to the end.
[[nodiscard]] std::vector<LandingSite> find_landing_sites(std::span<const Vec3> anchors_world_m,
                                                          double diagonal_m, double tool_radius_m,
                                                          std::size_t turned = 0);

} // namespace tactus
