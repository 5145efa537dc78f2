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

/// One object's surface near a tool, as the force stage sees it from where the proxy is.
struct PlacedSurface
{
    const ObjectPose* pose{nullptr};
    const LocalSurface* surface{nullptr};
    const Material* material{nullptr};
    double quantum_m{0.0}; ///< Of the model's coordinates, in its frame.
    /// How far round the tool's core it was asked for, in the world.
    double reach_m{kInfinity};
    /// Proven distance of the core, in the world; 0 where that is not known.
    double lower_m{0.0};
    /// World frame; null unless the tool is held as a body.
    const TouchReport* touches{nullptr};
    double upper_m{kInfinity}; ///< Some surface is within this of the core, in the world.
    std::uint32_t object{0};   ///< Its number in the scene.
    ProxyMemory* memory{nullptr};
    const Kernels* kernels{&portable_kernels()};
};

} // namespace tactus
