// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/refinement_state.hpp"
#include "transport/telemetry.hpp"

#include <span>
#include <string>

namespace tactus::view
{

/// Text about the force of a tool: "on", or "off: " and for each cause the condition under which
/// the force returns. `models` are those of the tool's controller. Any thread.
[[nodiscard]] std::string force_words(const RefinementStateTool& tool,
                                      const ToolTelemetry& telemetry,
                                      std::span<const ModelTelemetry> models);

} // namespace tactus::view
