// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/pair_query.hpp"
#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// FCL's distance between a BVHModel<OBBRSS<double>> and a sphere without a radius. No band.
[[nodiscard]] std::unique_ptr<TouchQuery> make_fcl_query(const std::vector<test::Face>& faces,
                                                         double radius_m);

/// The same with a sphere of the probe's radius: collide() reports a touch and the greatest depth
/// of all contacts, distance() the gap otherwise (about 0, of either sign, if they overlap). The
/// radius is added to obtain the distance of the centre.
[[nodiscard]] std::unique_ptr<TouchQuery>
make_fcl_sphere_query(const std::vector<test::Face>& faces, double radius_m);

/// FCL's collide() and distance() of two BVHModel<OBBRSS<double>>.
[[nodiscard]] std::unique_ptr<PairQuery> make_fcl_pair_query(const PairMeshes& meshes);

} // namespace tactus::bench
