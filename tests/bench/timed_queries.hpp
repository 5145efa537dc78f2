// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/least_times.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/point_query.hpp"
#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Points of a motion with their true distances.
struct Questions
{
    std::vector<Vec3> points_m;
    std::vector<double> truth_m;

    /// Frames in which the sphere's centre is within `distance_m`.
    [[nodiscard]] std::vector<bool> nearer_than(double distance_m) const;
};
[[nodiscard]] Questions ask(const Scene& scene, std::vector<Vec3> points_m);

struct QueryTimes
{
    LeastTimes us;
    std::uint64_t hash{0}; ///< Hash of the answers' bits, so that they are used.
};

/// Asks one contestant all questions in turn, `passes` times. A failure if an answer differs from
/// the truth by more than `tolerance_m`, if one beyond the band is given or one within it is
/// missing, or if passes differ.
[[nodiscard]] QueryTimes time_queries(PointQuery& query, const Questions& questions, double band_m,
                                      double tolerance_m, std::uint32_t passes);

} // namespace tactus::bench
