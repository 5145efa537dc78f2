// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// Embree's point query (rtcPointQuery) over a scene of triangles with separate corners, built at
/// high quality by one thread, in float. Its memory is that of its device's monitor, since the heap
/// counts only a part.
[[nodiscard]] std::unique_ptr<TouchQuery> make_embree_query(const std::vector<test::Face>& faces,
                                                            double radius_m);

} // namespace tactus::bench
