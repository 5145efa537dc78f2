// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

namespace tactus::bench
{

/// A capsule and a box sweep around the bumpy sphere, a box over a plane and its edge, a peg in its
/// hole and a cylinder across another one, each with and without friction: times, rendered forces
/// and torques, and the cost of friction.
void run_rigid_sweeps(const CaseContext& context);

} // namespace tactus::bench
