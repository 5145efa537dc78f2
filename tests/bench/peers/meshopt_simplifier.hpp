// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/mesh_simplifier.hpp"

namespace tactus::bench
{

/// meshopt_simplify without a bound on the error: an index list over unchanged vertices.
[[nodiscard]] SimplifiedMesh simplify_by_meshoptimizer(const QuantisedMesh& mesh,
                                                       std::uint32_t faces);

} // namespace tactus::bench
