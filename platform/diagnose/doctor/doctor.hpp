// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tactus::doctor
{

/// Runs all checks, in the order of display. Each returns one finding, even if files are missing.
[[nodiscard]] std::vector<Finding> examine(const MachineView& view);

[[nodiscard]] std::size_t count_of(const std::vector<Finding>& findings, Verdict verdict);

/// Report of all findings, with their number for each verdict; keys in docs/doctor.md.
[[nodiscard]] nlohmann::ordered_json make_report(const std::vector<Finding>& findings,
                                                 std::optional<int> cpu);

/// Text of the findings for a terminal of 100 columns. First stand the counts by verdict, then the
/// critical, unknown and advice findings. Good findings are listed by name, or in full if
/// `shows_good`. Only commands may be longer than a line, so that they can be copied.
[[nodiscard]] std::string make_text(const std::vector<Finding>& findings, bool shows_good);

} // namespace tactus::doctor
