// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/infinity.hpp"
#include "rt_core/records/object_pose.hpp"

#include <cstdint>

namespace tactus
{

/// Data of one object that a proxy keeps from frame to frame. World frame.
struct ProxyMemory
{
    /// Distance that the proxy may move without a change of side of the object's surface.
    double clearance_m{kInfinity};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0}; ///< Velocity of the object at the proxy.
    Vec3 spin_rad_per_s{0.0, 0.0, 0.0};   ///< Angular velocity of the object, for rigid tools.
};

/// Object near a tool at the beginning of a frame, with the poses of its model's frame before and
/// after this frame's changes. Both are one pointer if the object has not moved.
struct NearObject
{
    std::uint32_t object{0}; ///< Number of the object.
    const ObjectPose* before{nullptr};
    const ObjectPose* now{nullptr};
    ProxyMemory* memory{nullptr};
    double lower_m{0.0}; ///< Proven distance of the tool's core from the object in the last frame.

    [[nodiscard]] bool has_moved() const noexcept { return before != now; }
};

} // namespace tactus
