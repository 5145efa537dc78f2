// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/vec3.hpp"

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Pose of a frame, here, in another one, there, with a scale: there = translation + scale x
/// rotation x here. Metres; the rotation is orthonormal to rounding and right-handed, the scale
/// above 0; nothing of that is checked.
struct Similarity
{
    Mat3 rotation{Mat3::Identity()};
    Vec3 translation_m{0.0, 0.0, 0.0};
    double scale{1.0};

    [[nodiscard]] Vec3 local_to_world(const Vec3& here_m) const noexcept
    {
        return translation_m + scale * (rotation * here_m);
    }
    /// Inverse of local_to_world().
    [[nodiscard]] Vec3 world_to_local(const Vec3& there_m) const noexcept
    {
        const Vec3 relative = there_m - translation_m;
        return (rotation.transpose() * relative) / scale;
    }
};

/// Pose of the frame `here` in the frame `other`, both given in a third one. The other's scale must
/// be above 0 (asserted).
[[nodiscard]] inline Similarity in_frame(const Similarity& other, const Similarity& here) noexcept
{
    TACTUS_ASSERT(other.scale > 0.0);
    return {other.rotation.transpose() * here.rotation, other.world_to_local(here.translation_m),
            here.scale / other.scale};
}

} // namespace tactus
