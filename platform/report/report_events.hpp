// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tactus::hrtc
{

struct FinishedRun;

/// Part of the report on deadlines, with single cycles.
[[nodiscard]] nlohmann::ordered_json deadlines_of(const FinishedRun& run);

/// Part of the report on safety: brakes, and times and causes of fades.
[[nodiscard]] nlohmann::ordered_json safety_of(const FinishedRun& run);

/// Part of the report on the servers with authority and their events. Times count from the first
/// safety event; earlier ones are negative.
[[nodiscard]] nlohmann::ordered_json servers_of(const FinishedRun& run);

} // namespace tactus::hrtc
