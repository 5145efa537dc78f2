// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <vector>

namespace tactus::bench
{

/// What a host's objects cost on the wire and to those who join.
[[nodiscard]] std::vector<Case> scene_wire_cases();

/// What poses from outside do to a force, and what they cost a frame.
[[nodiscard]] std::vector<Case> scene_pose_cases();

/// In how much memory scenes start.
[[nodiscard]] std::vector<Case> scene_memory_cases();

} // namespace tactus::bench
