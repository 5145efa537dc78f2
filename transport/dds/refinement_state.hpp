// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/refinement_state.hpp"

#include <functional>
#include <optional>

struct tactus_v5_RefinementState; // idlc's type of this part of a sample.

// Any thread except the haptic one: calls allocate.
namespace tactus::dds
{

/// Calls `use` with the state as a part of a sample, which is valid during the call. The state must
/// keep the limits of transport/refinement_state.hpp, and its regions must refer to its models
/// (asserted).
void with_wire_state(const RefinementState& state,
                     const std::function<void(tactus_v5_RefinementState&)>& use);

/// Refinement state in a sample; none if its counts do not add up, its chunks do not ascend, or a
/// shape or a number is out of range.
[[nodiscard]] std::optional<RefinementState> state_from(const tactus_v5_RefinementState& wire);

} // namespace tactus::dds
