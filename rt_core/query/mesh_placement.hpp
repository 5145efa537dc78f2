// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// Placement of a model's frame in another model's: there = origin + scale x rotation x (here +
/// offset).
struct MeshPlacement
{
    Similarity place;
    Vec3 offset_m{0.0, 0.0, 0.0};

    [[nodiscard]] Vec3 local_to_world(const Vec3& here_m) const noexcept
    {
        return place.local_to_world(here_m + offset_m);
    }
    [[nodiscard]] MeshPlacement inverse() const noexcept TACTUS_NONBLOCKING;
    /// Bound on the rounding error of local_to_world(), in metres of the other frame.
    [[nodiscard]] double rounding_m(const Vec3& here_m) const noexcept TACTUS_NONBLOCKING;
};

} // namespace tactus
