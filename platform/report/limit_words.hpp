// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace tactus::hrtc
{

/// Text on the limit that most frames of the run reached, with their number and the remedy, such as
/// "no room for faces (forest_full in 12 frames): --pool-mib 8, 4 times as much". Empty if no limit
/// was reached.
[[nodiscard]] std::string limit_text(const nlohmann::ordered_json& report);

} // namespace tactus::hrtc
