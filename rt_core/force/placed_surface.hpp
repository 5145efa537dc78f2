// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/near_object.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/local_surface.hpp"

namespace tactus
{

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
