// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

namespace tactus::bench
{

/// Bodies that lie, slide and turn on flat sheets of any cell size, where force and torque are
/// known.
void run_body_sheets(const CaseContext& context);

/// Tools of a centimetre on dense meshes: how often they have a force and how well it is known.
void run_dense_meshes(const CaseContext& context);

} // namespace tactus::bench
