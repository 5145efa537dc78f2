// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/exact_splits.hpp"

#include "tests/shared/certificate_refinement.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_points.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::bench
{

ExactSplits measure_exact_splits(const DecodedModel& model, const std::vector<test::Face>& source,
                                 const test::FaceTree& tree, double radius_m, std::uint32_t probes,
                                 std::uint64_t seed)
{
    const test::CertificateRefinement refinement(model);
    test::SurfacePoints surface(source, seed);
    std::vector<double> splits;
    ExactSplits figures;
    for (std::uint32_t i = 0; i < probes; ++i)
    {
        const Vec3 direction(test::signed_unit(seed, 4 * i), test::signed_unit(seed, 4 * i + 1),
                             test::signed_unit(seed, 4 * i + 2));
        const double way_m = 2.0 * radius_m * std::abs(test::signed_unit(seed, 4 * i + 3));
        const Vec3 place_m = surface.draw_by_area() + way_m * direction.normalized();
        const auto answer = refinement.find_distance(place_m);
        splits.push_back(static_cast<double>(answer.splits.size()));
        figures.distance_error_max_m =
            std::max(figures.distance_error_max_m,
                     std::abs(answer.distance_m - tree.nearest(place_m).distance_m));
    }
    figures.splits = contact_spread_of(splits);
    return figures;
}

} // namespace tactus::bench
