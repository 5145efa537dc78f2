// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>
#include <string_view>

namespace tactus
{

struct DeviceLimits;

} // namespace tactus

// Any thread except the haptic one, because strings allocate.
namespace tactus::hrtc
{

struct ToolOptions;

/// Each parses the value of one option of a tool and sets it: of --tool, --tool-mass, --fixture,
/// --device, --device-limits, --device-frame and --motion, in this order. Returns the fault, and
/// then changes nothing; empty if there is none. The device comes before its limits, frame and
/// motion.
[[nodiscard]] std::string set_tool_shape(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_mass(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_fixture(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_device(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_limits(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_frame(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_edit(const std::string& text, ToolOptions& tool);
[[nodiscard]] std::string set_tool_motion(const std::string& text, ToolOptions& tool);

/// Sets device limits from `KEY=VALUE` pairs, separated by commas. The keys are the member names of
/// DeviceLimits, in SI units; those of RotationLimits begin with `rotation.`. Returns the fault,
/// and then changes nothing; empty if there is none.
[[nodiscard]] std::string set_device_limits(std::string_view text, DeviceLimits& limits);

} // namespace tactus::hrtc
