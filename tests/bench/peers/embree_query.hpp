// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// Embree's point query (rtcPointQuery) over a scene of triangles with shared vertices as separate
/// corners, built at high quality by one thread. In float throughout, as its users have it. Its
/// memory is what its device's monitor counts, which the heap knows a part of only.
[[nodiscard]] std::unique_ptr<TouchQuery> make_embree_query(const std::vector<test::Face>& faces,
                                                            double radius_m);

} // namespace tactus::bench
