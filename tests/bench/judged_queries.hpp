// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/least_times.hpp"
#include "tests/bench/peers/point_query.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/timed_queries.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus::bench
{

/// What one contestant said of some questions, right or wrong, and how long it took.
struct PointAnswers
{
    LeastTimes us;
    std::vector<double> distances_m;
    std::vector<Vec3> nearest_m;              ///< Where the distance is finite.
    std::uint64_t hash{0};                    ///< Over the distances' bits: they were used.
    std::optional<std::uint64_t> allocations; ///< Of all questions; none where none are counted.
};

/// Asks all questions in turn, each with a band of its own, `passes` times from the start: as in a
/// loop that is on its way, the first one was asked once before. A failure only when passes differ.
[[nodiscard]] PointAnswers replay_queries(TouchQuery& query, std::span<const Vec3> points_m,
                                          std::span<const double> bands_m, std::uint32_t passes);

/// How wrong answers are about touch: a probe of a radius touches where the distance of its centre
/// is less.
struct TouchErrors
{
    std::uint64_t missed{0};   ///< It touches, and the answer says no.
    std::uint64_t invented{0}; ///< It does not, and the answer says so.

    TouchErrors& operator+=(const TouchErrors& other)
    {
        missed += other.missed;
        invented += other.invented;
        return *this;
    }
};
/// What is within `tolerance_m` of the radius may be told either way. An answer that is not a
/// number says no.
[[nodiscard]] TouchErrors judge_touch(std::span<const double> answers_m,
                                      std::span<const double> truth_m, double radius_m,
                                      double tolerance_m);

/// The largest error of a distance, all counted as the band where they are beyond it; infinite for
/// one that is not a number.
[[nodiscard]] double largest_error_m(std::span<const double> answers_m,
                                     std::span<const double> truth_m,
                                     std::span<const double> bands_m);

/// How far the told nearest points are off at most: from the surface, and in their distance from
/// the question's point. Which one of several that are as near is told, does not matter.
[[nodiscard]] double largest_point_error_m(const PointAnswers& answers, const Questions& questions,
                                           const test::FaceTree& tree);

/// A contestant and what it cost to make it.
struct BuiltQuery
{
    std::unique_ptr<TouchQuery> query;
    double build_ms{0.0};
    double bytes{0.0};
};
/// Throws what the peer throws that refuses the mesh.
[[nodiscard]] BuiltQuery build_peer(const PointPeer& peer, const std::vector<test::Face>& faces,
                                    double radius_m);

} // namespace tactus::bench
