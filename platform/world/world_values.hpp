// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/sweep.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/world/world_parts.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/records/material.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <optional>
#include <string>

// Values that a program gives to a World: in range, or refused in one line. Any thread except the
// haptic one.
namespace tactus
{

/// Refusal of an argument or option out of its range.
[[nodiscard]] Refusal wrong_value(std::string text);

[[nodiscard]] Result<Material, Refusal> checked_material(const MaterialOptions& options);
[[nodiscard]] Result<Similarity, Refusal> checked_place(const Pose& pose);
/// Fault of a pose of a hand; empty if it is in range.
[[nodiscard]] std::optional<Refusal> fault_of(const HandPose& pose);
/// Shape of a tool without a model; that of a hull's file is not read.
[[nodiscard]] Result<hrtc::ToolChoice, Refusal> checked_shape(const WorldTool& tool);
/// Sweep of a tool that can carve.
[[nodiscard]] Result<Sweep, Refusal> checked_sweep(const WorldTool& shape, const HandPose& from,
                                                   const std::array<double, 3>& to_m);

} // namespace tactus

namespace tactus::hrtc
{

/// The text with the names of hrtc's options replaced by those of a World.
[[nodiscard]] std::string world_words(std::string text);

[[nodiscard]] inline Refusal in_world_words(const Refusal& refusal)
{
    return {world_words(refusal.text), refusal.is_usage};
}

} // namespace tactus::hrtc
