// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/tool_port.hpp"
#include "rt_core/records/material.hpp"

#include <optional>
#include <span>
#include <string>

namespace tactus::hrtc
{

/// No hand feels a softer wall: 0.1 N a centimetre deep.
inline constexpr double kSoftestFelt_n_per_m = 10.0;

/// Why the object of this name, and of this material, gives a tool no wall: its damping leaves that
/// tool's device none. Nothing where every tool feels it that feels anything. The tools have their
/// devices, here and below.
[[nodiscard]] std::optional<std::string>
why_unfelt(const std::string& name, const Material& material, std::span<const ToolSetup> tools);

/// What tools may feel of a material that a server says: within the ranges that --material has, and
/// damped no more than leaves each device the tool's stiffness, or half of what it carries without
/// damping where that is less. `material` is sound.
[[nodiscard]] Material limited(const Material& material, std::span<const ToolSetup> tools);

/// The values in which both differ, by their names: "damping 20 to 0.139, static 50 to 3".
[[nodiscard]] std::string differences(const Material& from, const Material& to);

} // namespace tactus::hrtc
