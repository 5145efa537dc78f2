// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/finding.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tactus::doctor
{

/// Report of all findings, with their number for each verdict; keys in docs/doctor.md.
[[nodiscard]] nlohmann::ordered_json make_report(const std::vector<Finding>& findings,
                                                 std::optional<int> cpu);

/// Text of the findings for a terminal of 100 columns. First stand the counts by verdict, then the
/// critical, unknown and advice findings. Good findings are listed by name, or in full if
/// `shows_good`. Only commands may be longer than a line, so that they can be copied.
[[nodiscard]] std::string make_text(const std::vector<Finding>& findings, bool shows_good);

} // namespace tactus::doctor
