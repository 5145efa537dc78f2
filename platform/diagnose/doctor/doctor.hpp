// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <cstddef>
#include <vector>

namespace tactus::doctor
{

/// Runs all checks, in the order of display. Each returns one finding, even if files are missing.
[[nodiscard]] std::vector<Finding> examine(const MachineView& view);

[[nodiscard]] std::size_t count_of(const std::vector<Finding>& findings, Verdict verdict);

} // namespace tactus::doctor
