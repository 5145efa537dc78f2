// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/timed_queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::bench
{

namespace
{

/// True if the answer is right for a question; either answer is right on the band's edge.
bool is_right(double answer_m, double truth_m, double band_m, double tolerance_m)
{
    if (std::isinf(answer_m))
    {
        return truth_m >= band_m - tolerance_m;
    }
    return std::abs(answer_m - truth_m) <= tolerance_m;
}

} // namespace

std::vector<bool> Questions::nearer_than(double distance_m) const
{
    std::vector<bool> near(truth_m.size());
    std::transform(truth_m.begin(), truth_m.end(), near.begin(),
                   [&](double truth) { return truth <= distance_m; });
    return near;
}

Questions ask(const Scene& scene, std::vector<Vec3> points_m)
{
    Questions questions{std::move(points_m), {}};
    for (const Vec3& point : questions.points_m)
    {
        questions.truth_m.push_back(scene.tree->nearest(point).distance_m);
    }
    return questions;
}

QueryTimes time_queries(PointQuery& query, const Questions& questions, double band_m,
                        double tolerance_m, std::uint32_t passes)
{
    QueryTimes times{LeastTimes(questions.points_m.size()), 0};
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        std::uint64_t hash = 0;
        for (std::size_t i = 0; i < questions.points_m.size(); ++i)
        {
            const BenchClock::time_point start = BenchClock::now();
            const double answer_m = query.distance_m(questions.points_m[i], band_m);
            times.us.keep(i, microseconds(start, BenchClock::now()));
            if (!is_right(answer_m, questions.truth_m[i], band_m, tolerance_m))
            {
                throw Failure(fmt::format("{} answers {} m in frame {}; the truth is {} m",
                                          query.name(), answer_m, i, questions.truth_m[i]));
            }
            hash += std::bit_cast<std::uint64_t>(answer_m) * (2 * i + 1);
        }
        if (pass > 0 && hash != times.hash)
        {
            throw Failure(query.name() + ": passes over the same points gave other answers");
        }
        times.hash = hash;
    }
    return times;
}

} // namespace tactus::bench
