// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"

#include <limits>
#include <meshoptimizer.h>

namespace tactus::bench
{

SimplifiedMesh simplify_by_meshoptimizer(const QuantisedMesh& mesh, std::uint32_t faces)
{
    SimplifiedMesh simplified;
    std::vector<float> coordinates;
    for (const auto& [x, y, z] : mesh.positions)
    {
        coordinates.insert(coordinates.end(),
                           {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        simplified.mesh.positions.push_back(
            {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    std::vector<unsigned> indices;
    for (const auto& corners : mesh.faces)
    {
        indices.insert(indices.end(), corners.begin(), corners.end());
    }
    std::vector<unsigned> left(indices.size());
    const BenchClock::time_point start = BenchClock::now();
    left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), coordinates.data(),
                                 mesh.positions.size(), 3 * sizeof(float), std::size_t{3} * faces,
                                 std::numeric_limits<float>::max(), 0, nullptr));
    const BenchClock::time_point end = BenchClock::now();
    simplified.seconds = seconds(start, end);
    for (std::size_t i = 0; i < left.size(); i += 3)
    {
        simplified.mesh.faces.push_back({left[i], left[i + 1], left[i + 2]});
    }
    return simplified;
}

} // namespace tactus::bench
