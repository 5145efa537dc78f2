// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <vector>

namespace tactus::bench
{

/// Cost of a model server's objects on the wire and for joining controllers.
[[nodiscard]] std::vector<Case> scene_wire_cases();

/// Effect of external poses on a force, and their cost in a frame.
[[nodiscard]] std::vector<Case> scene_pose_cases();

/// Memory in which scenes start.
[[nodiscard]] std::vector<Case> scene_memory_cases();

} // namespace tactus::bench
