// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/material.hpp"

#include <optional>
#include <span>
#include <string>

namespace tactus::hrtc
{

struct ToolSetup;

/// Least stiffness that is perceptible: 0.1 N at a penetration of 1 cm.
inline constexpr double kSoftestFelt_n_per_m = 10.0;

/// Reason why a tool can't feel the object called `name`: the damping of its material leaves the
/// tool's device less than kSoftestFelt. None if every tool feels it. Tools whose devices allow
/// less even undamped are left out. Here and below, each tool must have its device.
[[nodiscard]] std::optional<std::string>
why_unfelt(const std::string& name, const Material& material, std::span<const ToolSetup> tools);

/// Material that tools may render instead of `material`: within the ranges of --material, and with
/// so little damping that each device still allows its tool's stiffness, or half of the device's
/// undamped limit if that is less. `material` must satisfy is_sound().
[[nodiscard]] Material limited(const Material& material, std::span<const ToolSetup> tools);

/// Differences between two materials by name, such as "damping 20 to 0.139, static 50 to 3".
[[nodiscard]] std::string differences(const Material& from, const Material& to);

} // namespace tactus::hrtc
