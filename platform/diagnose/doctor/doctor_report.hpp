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

/// Every finding and how many there are of each verdict; keys in docs/doctor.md.
[[nodiscard]] nlohmann::ordered_json make_report(const std::vector<Finding>& findings,
                                                 std::optional<int> cpu);

/// The same for a terminal of 100 columns: how many there are of each verdict, then what is
/// critical, unknown, and advice; what is good by its names, or each as the others. Only commands
/// may be longer: they are not broken, so that they can be copied.
[[nodiscard]] std::string make_text(const std::vector<Finding>& findings, bool shows_good);

} // namespace tactus::doctor
