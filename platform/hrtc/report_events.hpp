// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tactus::hrtc
{

class SafetyRecord;
struct FinishedRun;

/// What the report says of a run's deadlines, and of single cycles of it.
[[nodiscard]] nlohmann::ordered_json deadlines_of(const FinishedRun& run);

/// What it says of the force that was off, when and why.
[[nodiscard]] nlohmann::ordered_json safety_of(const SafetyRecord& safety, bool supervisor_fifo);

} // namespace tactus::hrtc
