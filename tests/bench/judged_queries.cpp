// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/judged_queries.hpp"

#include "tests/bench/measuring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

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

namespace
{

void ask_once(TouchQuery& query, std::span<const Vec3> points_m, std::span<const double> bands_m,
              PointAnswers& answers)
{
    for (std::size_t i = 0; i < points_m.size(); ++i)
    {
        const BenchClock::time_point start = BenchClock::now();
        answers.distances_m[i] = query.distance_m(points_m[i], bands_m[i]);
        answers.us.keep(i, microseconds(start, BenchClock::now()));
        answers.nearest_m[i] = query.nearest_m();
    }
}

std::uint64_t hash_of(std::span<const double> values)
{
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        hash += std::bit_cast<std::uint64_t>(values[i]) * (2 * i + 1);
    }
    return hash;
}

} // namespace

PointAnswers replay_queries(TouchQuery& query, std::span<const Vec3> points_m,
                            std::span<const double> bands_m, std::uint32_t passes)
{
    const std::size_t count = points_m.size();
    PointAnswers answers{LeastTimes(count), std::vector<double>(count), std::vector<Vec3>(count), 0,
                         std::nullopt};
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        query.forget();
        if (count > 0)
        {
            answers.distances_m[0] = query.distance_m(points_m[0], bands_m[0]);
        }
        answers.allocations = counted_if_available(
            allocations_of([&] { ask_once(query, points_m, bands_m, answers); }));
        const std::uint64_t hash = hash_of(answers.distances_m);
        if (pass > 0 && hash != answers.hash)
        {
            throw Failure(query.name() + ": passes over the same points gave other answers");
        }
        answers.hash = hash;
    }
    return answers;
}

TouchErrors judge_touch(std::span<const double> answers_m, std::span<const double> truth_m,
                        double radius_m, double tolerance_m)
{
    TouchErrors errors;
    for (std::size_t i = 0; i < answers_m.size(); ++i)
    {
        const bool is_told = answers_m[i] < radius_m;
        errors.missed += truth_m[i] < radius_m - tolerance_m && !is_told ? 1U : 0U;
        errors.invented += truth_m[i] > radius_m + tolerance_m && is_told ? 1U : 0U;
    }
    return errors;
}

double largest_error_m(std::span<const double> answers_m, std::span<const double> truth_m,
                       std::span<const double> bands_m)
{
    double largest_m = 0.0;
    for (std::size_t i = 0; i < answers_m.size(); ++i)
    {
        const double told_m = std::min(answers_m[i], bands_m[i]);
        const double error_m = std::abs(told_m - std::min(truth_m[i], bands_m[i]));
        largest_m = std::isnan(error_m) ? std::numeric_limits<double>::infinity()
                                        : std::max(largest_m, error_m);
    }
    return largest_m;
}

double largest_point_error_m(const PointAnswers& answers, const Questions& questions,
                             const test::FaceTree& tree)
{
    double largest_m = 0.0;
    for (std::size_t i = 0; i < answers.nearest_m.size(); ++i)
    {
        if (!std::isfinite(answers.distances_m[i]))
        {
            continue;
        }
        const Vec3& told_m = answers.nearest_m[i];
        const double away_m = (told_m - questions.points_m[i]).norm();
        largest_m = std::max(
            {largest_m, tree.nearest(told_m).distance_m, std::abs(away_m - questions.truth_m[i])});
    }
    return largest_m;
}

BuiltQuery build_peer(const PointPeer& peer, const std::vector<test::Face>& faces, double radius_m)
{
    BuiltQuery built;
    const std::size_t bytes_before = heap_bytes();
    const BenchClock::time_point start = BenchClock::now();
    built.query = peer.make(faces, radius_m);
    built.build_ms = 1e-3 * microseconds(start, BenchClock::now());
    const std::size_t bytes = heap_bytes() - bytes_before;
    built.bytes = static_cast<double>(built.query->own_bytes().value_or(bytes));
    return built;
}

} // namespace tactus::bench
