// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/material.hpp"
#include "transport/pose.hpp"

struct tactus_v5_ObjectRecord; // idlc's types.
struct tactus_v5_Placement;

namespace tactus::dds
{

/// Conversion of a pose to and from the wire. Values are not checked (checked_pose()).
[[nodiscard]] tactus_v5_Placement to_wire(const Pose& pose) noexcept;
[[nodiscard]] Pose from_wire(const tactus_v5_Placement& wire) noexcept;

/// Conversion of a material to and from the wire. Values are not checked (is_sound()). A stiffness
/// of 0 on the wire means the stiffness of the tool.
void put_material(const Material& material, tactus_v5_ObjectRecord& wire) noexcept;
[[nodiscard]] Material material_of(const tactus_v5_ObjectRecord& wire) noexcept;

} // namespace tactus::dds
