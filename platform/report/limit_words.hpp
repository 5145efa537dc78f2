// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace tactus::hrtc
{

/// The pool or budget that most frames of the run came to the end of, with the figure and what
/// helps: "no room for faces (pool of 2 MiB): --pool-mib 8". Empty when there was none.
[[nodiscard]] std::string limit_text(const nlohmann::ordered_json& report);

} // namespace tactus::hrtc
