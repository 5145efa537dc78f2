// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/infinity.hpp"
#include "rt_core/records/object_pose.hpp"

#include <cstdint>

namespace tactus
{

/// What a proxy keeps of an object from frame to frame. World frame.
struct ProxyMemory
{
    /// It may move by this much before it is on the other side of the object's surface.
    double clearance_m{kInfinity};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0}; ///< The object's, at the proxy.
    Vec3 spin_rad_per_s{0.0, 0.0, 0.0};   ///< The object's; only a body's proxy asks for it.
};

/// An object near a tool as a frame begins: of the model's frame, where it stood and where it
/// stands now; the same pose where it has not moved.
struct NearObject
{
    std::uint32_t object{0}; ///< Its number.
    const ObjectPose* before{nullptr};
    const ObjectPose* now{nullptr};
    ProxyMemory* memory{nullptr};
    double lower_m{0.0}; ///< Proven distance of the tool's core in the last frame.

    [[nodiscard]] bool has_moved() const noexcept { return before != now; }
};

} // namespace tactus
