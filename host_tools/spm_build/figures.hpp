// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/build/build_model.hpp"

#include <nlohmann/json_fwd.hpp>

namespace tactus::spm_build
{

/// Figures for --json.
[[nodiscard]] nlohmann::json figures_of(const BuiltModel& model);

} // namespace tactus::spm_build
