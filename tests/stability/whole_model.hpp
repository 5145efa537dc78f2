// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace tactus::test
{

/// Options of a rig in which models of `faces` are refined fully and stay so.
[[nodiscard]] RigOptions whole_options(std::size_t faces);

/// Steps until every model is refined fully; ends the program if that never happens.
void refine_fully(const std::string& name,
                  const std::function<FrameOutput(const Budgets& budgets)>& step);

} // namespace tactus::test
