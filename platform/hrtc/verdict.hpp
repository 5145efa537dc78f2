// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace tactus::hrtc
{

/// No hand feels a softer wall: 0.1 N a centimetre deep.
inline constexpr double kSoftestFelt_n_per_m = 10.0;

/// What was lost in a run, or came to nothing: with --strict it has failed then. Words, one each.
[[nodiscard]] std::vector<std::string> losses_of(const nlohmann::ordered_json& report);

/// Everything that nobody wants to see of a run, the losses among it; none when it was as it should
/// be.
[[nodiscard]] std::vector<std::string> complaints_of(const nlohmann::ordered_json& report);

} // namespace tactus::hrtc
