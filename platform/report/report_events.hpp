// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tactus::hrtc
{

struct FinishedRun;

/// What the report says of a run's deadlines, and of single cycles of it.
[[nodiscard]] nlohmann::ordered_json deadlines_of(const FinishedRun& run);

/// What it says of the force that was off, when and why.
[[nodiscard]] nlohmann::ordered_json safety_of(const FinishedRun& run);

/// What it says of the servers whose word counts: what became of them, and when; before the loop
/// below 0 s.
[[nodiscard]] nlohmann::ordered_json servers_of(const FinishedRun& run);

} // namespace tactus::hrtc
