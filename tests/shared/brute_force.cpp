// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/brute_force.hpp"

#include "tests/shared/distance_oracle.hpp"

#include <algorithm>

namespace tactus::test
{

long double brute_distance(const Vec3& point, const Face& face)
{
    return DistanceOracle::distance(point, to_triangle(face));
}

long double brute_distance(const Vec3& point, const std::vector<Face>& faces)
{
    long double best = DistanceOracle::kInfinity;
    for (const Face& face : faces)
    {
        best = std::min(best, brute_distance(point, face));
    }
    return best;
}

} // namespace tactus::test
