// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/peers/point_query.hpp"

#include <memory>
#include <vector>

namespace tactus::bench
{

/// CGAL's AABB_tree of triangles in double precision, Simple_cartesian<double>. The hint for the
/// closest point is the last answer's, the first corner for the first question. No band.
[[nodiscard]] std::unique_ptr<TouchQuery> make_cgal_query(const std::vector<test::Face>& faces,
                                                          double radius_m);

} // namespace tactus::bench
