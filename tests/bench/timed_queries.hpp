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

/// The points of a motion and the true distances there.
struct Questions
{
    std::vector<Vec3> points_m;
    std::vector<double> truth_m;

    /// Frames in which the probe's centre is within `distance_m`.
    [[nodiscard]] std::vector<bool> nearer_than(double distance_m) const;
};
[[nodiscard]] Questions ask(const Scene& scene, std::vector<Vec3> points_m);

struct QueryTimes
{
    LeastTimes us;
    std::uint64_t hash{0}; ///< Over the answers' bits: they were used.
};

/// Asks one contestant all questions in turn, `passes` times. A failure when an answer is farther
/// from the truth than `tolerance_m`, when one beyond the band is given or one within is not, and
/// when passes differ.
[[nodiscard]] QueryTimes time_queries(PointQuery& query, const Questions& questions, double band_m,
                                      double tolerance_m, std::uint32_t passes);

} // namespace tactus::bench
