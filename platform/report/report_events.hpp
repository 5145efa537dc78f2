// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tactus::hrtc
{

struct FinishedRun;

/// Deadlines of a run in the report, with single cycles.
[[nodiscard]] nlohmann::ordered_json deadlines_of(const FinishedRun& run);

/// Times and causes without force in the report.
[[nodiscard]] nlohmann::ordered_json safety_of(const FinishedRun& run);

/// Servers with authority in the report, with their events. Times count from the first safety
/// event; earlier ones are negative.
[[nodiscard]] nlohmann::ordered_json servers_of(const FinishedRun& run);

} // namespace tactus::hrtc
