// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/pair_query.hpp"
#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// FCL's distance between a BVHModel<OBBRSS<double>> and a sphere without a radius. It knows no
/// band.
[[nodiscard]] std::unique_ptr<TouchQuery> make_fcl_query(const std::vector<test::Face>& faces,
                                                         double radius_m);

/// The same with the probe as a sphere of its radius: collide() tells whether it touches and the
/// greatest depth of all contacts, distance() the gap where it doesn't (of what overlaps it says 0
/// or so, of either sign). The radius is added, for the distance of the centre.
[[nodiscard]] std::unique_ptr<TouchQuery>
make_fcl_sphere_query(const std::vector<test::Face>& faces, double radius_m);

/// FCL's collide() and distance() of two BVHModel<OBBRSS<double>>.
[[nodiscard]] std::unique_ptr<PairQuery> make_fcl_pair_query(const PairMeshes& meshes);

} // namespace tactus::bench
