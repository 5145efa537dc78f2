// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/wire_values.hpp"

#include <algorithm>
#include <iterator>

#include "tactus.h"

namespace tactus::dds
{

tactus_v5_Placement to_wire(const Pose& pose) noexcept
{
    tactus_v5_Placement wire = {};
    std::ranges::copy(pose.rotation, std::begin(wire.rotation));
    std::ranges::copy(pose.translation_m, std::begin(wire.translation_m));
    wire.scale = pose.scale;
    return wire;
}

Pose from_wire(const tactus_v5_Placement& wire) noexcept
{
    Pose pose;
    std::ranges::copy(wire.rotation, pose.rotation.begin());
    std::ranges::copy(wire.translation_m, pose.translation_m.begin());
    pose.scale = wire.scale;
    return pose;
}

void put_material(const Material& material, tactus_v5_ObjectRecord& wire) noexcept
{
    const bool is_rigid = material.stiffness_n_per_m == kInfinity;
    wire.stiffness_n_per_m = is_rigid ? 0.0 : material.stiffness_n_per_m;
    wire.static_friction = material.static_friction;
    wire.dynamic_friction = material.dynamic_friction;
    wire.damping_n_s_per_m = material.damping_n_s_per_m;
    wire.viscosity_n_s_per_m = material.viscosity_n_s_per_m;
    wire.texture_height_m = material.texture_height_m;
    wire.texture_length_m = material.texture_length_m;
}

Material material_of(const tactus_v5_ObjectRecord& wire) noexcept
{
    const bool is_rigid = wire.stiffness_n_per_m == 0.0;
    return {is_rigid ? kInfinity : wire.stiffness_n_per_m,
            wire.static_friction,
            wire.dynamic_friction,
            wire.damping_n_s_per_m,
            wire.viscosity_n_s_per_m,
            wire.texture_height_m,
            wire.texture_length_m};
}

} // namespace tactus::dds
