// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/film.hpp"
#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_shelf.hpp"

#include <string>

// Any thread: functions of their arguments alone; they allocate.
namespace tactus::view
{

/// A snapshot as one line of JSON (docs/view.md): all controllers, and all data of the controller
/// `chosen` (empty: the first one). `domain_id` is that of the program. With `films`, the snapshot
/// is from those, and the line contains data about them.
[[nodiscard]] std::string state_json(const Snapshot& snapshot, const ModelShelf& shelf,
                                     const std::string& chosen, std::uint32_t domain_id,
                                     const Films* films = nullptr);

/// A snapshot in the text format of Prometheus: counts and gauges of each controller.
[[nodiscard]] std::string metrics_text(const Snapshot& snapshot);

} // namespace tactus::view
