// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/material.hpp"
#include "transport/pose.hpp"
#include "transport/refinement_state.hpp"

#include <functional>
#include <optional>

struct tactus_v5_ObjectRecord; // idlc's types.
struct tactus_v5_Placement;

struct tactus_v5_RefinementState; // idlc's type of this part of a sample.

// Any thread except the haptic one: calls allocate.
namespace tactus::dds
{

/// Conversion of a pose to and from the wire. Values are not checked (checked_pose()).
[[nodiscard]] tactus_v5_Placement to_wire(const Pose& pose) noexcept;
[[nodiscard]] Pose from_wire(const tactus_v5_Placement& wire) noexcept;

/// Conversion of a material to and from the wire. Values are not checked (is_sound()). A stiffness
/// of 0 on the wire means the stiffness of the tool.
void put_material(const Material& material, tactus_v5_ObjectRecord& wire) noexcept;
[[nodiscard]] Material material_of(const tactus_v5_ObjectRecord& wire) noexcept;

/// Calls `use` with the state as a part of a sample, which is valid during the call. The state must
/// keep the limits of transport/refinement_state.hpp, and its regions must refer to its models
/// (asserted).
void with_wire_state(const RefinementState& state,
                     const std::function<void(tactus_v5_RefinementState&)>& use);

/// Refinement state in a sample; none if its counts do not add up, its chunks do not ascend, or a
/// shape or a number is out of range.
[[nodiscard]] std::optional<RefinementState> state_from(const tactus_v5_RefinementState& wire);

} // namespace tactus::dds
