// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

namespace tactus::bench
{

/// A capsule and a box sweep round the bumpy sphere, a box over a plane and its edge, a peg in its
/// hole and a cylinder across another one, each without friction and with it: times, forces and
/// torques felt, and what friction costs a frame.
void run_rigid_sweeps(const CaseContext& context);

} // namespace tactus::bench
