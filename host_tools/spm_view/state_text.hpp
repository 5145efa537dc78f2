// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/film.hpp"
#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_shelf.hpp"
#include "transport/refinement_state.hpp"
#include "transport/telemetry.hpp"

#include <span>
#include <string>

// Any thread: results depend on the arguments alone. Strings allocate.
namespace tactus::view
{

/// Snapshot as one line of JSON (docs/view.md): all controllers, and all data of the controller
/// with the id `chosen` (empty: the first one). `domain_id` is the program's DDS domain. With
/// `films`, the snapshot must be from these, and the line has their data too.
[[nodiscard]] std::string state_json(const Snapshot& snapshot, const ModelShelf& shelf,
                                     const std::string& chosen, std::uint32_t domain_id,
                                     const Films* films = nullptr);

/// Snapshot in the text format of Prometheus: counters and gauges of each controller.
[[nodiscard]] std::string metrics_text(const Snapshot& snapshot);

/// Text about the force of a tool: "on", or "off: " and for each cause the condition under which
/// the force returns. `models` are those of the tool's controller. Any thread.
[[nodiscard]] std::string force_words(const RefinementStateTool& tool,
                                      const ToolTelemetry& telemetry,
                                      std::span<const ModelTelemetry> models);

} // namespace tactus::view
