// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// Bullet's contactPairTest() of a sphere with a btBvhTriangleMeshShape (quantised boxes, as most
/// use it), asked for contacts within the band; the least distance that it tells. In float, the
/// mesh scaled to a diagonal of 10: Bullet's tolerances are made for objects of some units. Without
/// a band it would test every triangle.
[[nodiscard]] std::unique_ptr<TouchQuery> make_bullet_query(const std::vector<test::Face>& faces,
                                                            double radius_m);

} // namespace tactus::bench
