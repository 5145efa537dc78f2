// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/local_surface.hpp"
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

/// Surface of one object near a tool, as queried from the proxy, for the force stage.
struct PlacedSurface
{
    const ObjectPose* pose{nullptr};
    const LocalSurface* surface{nullptr};
    const Material* material{nullptr};
    double quantum_m{0.0}; ///< Quantum of the model's coordinates, in metres of the model's frame.
    /// Range of the query round the tool's core, in metres of the world.
    double reach_m{kInfinity};
    /// Lower bound on the core's distance from the surface, in metres of the world; 0 if unknown.
    double lower_m{0.0};
    /// Possible contacts in the world frame; null unless the tool is rigid.
    const TouchReport* touches{nullptr};
    /// Upper bound on the core's distance from the surface, in metres of the world.
    double upper_m{kInfinity};
    std::uint32_t object{0}; ///< Number of the object in the scene.
    ProxyMemory* memory{nullptr};
    const Kernels* kernels{&portable_kernels()};
};

} // namespace tactus
