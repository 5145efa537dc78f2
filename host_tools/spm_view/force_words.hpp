// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/front.hpp"
#include "transport/telemetry.hpp"

#include <span>
#include <string>

namespace tactus::view
{

/// What becomes of a tool's force, for people: "on", or "off: " with each cause and what brings the
/// force back. `models` are those of the controller. Any thread.
[[nodiscard]] std::string force_words(const FrontTool& tool, const ToolTelemetry& telemetry,
                                      std::span<const ModelTelemetry> models);

} // namespace tactus::view
