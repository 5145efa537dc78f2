// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/mesh_simplifier.hpp"

namespace tactus::bench
{

/// OpenMesh's decimater with its quadric module only, over its default triangle mesh in float:
/// half-edge collapses, no bound on the error.
[[nodiscard]] SimplifiedMesh simplify_by_openmesh(const QuantisedMesh& mesh, std::uint32_t faces);

} // namespace tactus::bench
