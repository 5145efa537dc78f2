// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// Bullet's contactPairTest() of a sphere with a btBvhTriangleMeshShape (quantised boxes, the usual
/// choice), asked for contacts within the band; returns the least distance. The mesh is in float,
/// scaled to a diagonal of 10, since Bullet's tolerances are for objects of some units. Without a
/// band, every triangle would be tested.
[[nodiscard]] std::unique_ptr<TouchQuery> make_bullet_query(const std::vector<test::Face>& faces,
                                                            double radius_m);

} // namespace tactus::bench
