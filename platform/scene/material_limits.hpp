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

/// Least stiffness that is perceptible: 0.1 N a centimetre deep.
inline constexpr double kSoftestFelt_n_per_m = 10.0;

/// Reason why this object of this material is imperceptible to a tool: its damping leaves that
/// tool's device no stiffness. None if every tool with any stiffness feels it. The tools have their
/// devices, here and below.
[[nodiscard]] std::optional<std::string>
why_unfelt(const std::string& name, const Material& material, std::span<const ToolSetup> tools);

/// The material that tools may render of a server's: within the ranges of --material, and damped so
/// that each device keeps the tool's stiffness, or half of its undamped limit if that is less.
/// `material` must be sound.
[[nodiscard]] Material limited(const Material& material, std::span<const ToolSetup> tools);

/// Differences between both by name: "damping 20 to 0.139, static 50 to 3".
[[nodiscard]] std::string differences(const Material& from, const Material& to);

} // namespace tactus::hrtc
