// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/mesh_simplifier.hpp"

namespace tactus::bench
{

/// CGAL's edge_collapse over a Surface_mesh in double, with cost and placement by the plane
/// quadrics of Garland and Heckbert only.
[[nodiscard]] SimplifiedMesh simplify_by_garland_heckbert(const QuantisedMesh& mesh,
                                                          std::uint32_t faces);

/// The same without collapses that turn a face's normal too far, as in CGAL's example.
[[nodiscard]] SimplifiedMesh simplify_by_bounded_garland_heckbert(const QuantisedMesh& mesh,
                                                                  std::uint32_t faces);

/// The same with cost and placement of Lindstrom and Turk, CGAL's default.
[[nodiscard]] SimplifiedMesh simplify_by_lindstrom_turk(const QuantisedMesh& mesh,
                                                        std::uint32_t faces);

} // namespace tactus::bench
