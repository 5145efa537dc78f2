// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

namespace tactus::hrtc
{

/// Where an object stands: world = translation + scale x rotation x source point, where source
/// points are those of the mesh file in metres.
struct Placement
{
    Vec3 translation_m{0.0, 0.0, 0.0};
    Vec3 rotation_deg{0.0, 0.0, 0.0}; ///< Rotation vector: axis times angle.
    double scale{1.0};
};

/// Orthonormal to 2e-15. Made once an object, as a host's poses are once each (object_pose.hpp):
/// no frame ever composes two rotations, so there is nothing to drift.
[[nodiscard]] Mat3 rotation_of(const Placement& placement);

} // namespace tactus::hrtc
