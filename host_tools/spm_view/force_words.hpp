// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/front.hpp"
#include "transport/telemetry.hpp"

#include <span>
#include <string>

namespace tactus::view
{

/// Text about a tool's force: "on", or "off: " with each cause and the condition for its return.
/// `models` are those of the controller. Any thread.
[[nodiscard]] std::string force_words(const RefinementStateTool& tool,
                                      const ToolTelemetry& telemetry,
                                      std::span<const ModelTelemetry> models);

} // namespace tactus::view
