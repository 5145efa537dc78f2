// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"
#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

/// Answers of one contestant, right or wrong, with their times.
struct PointAnswers
{
    LeastTimes us;
    std::vector<double> distances_m;
    std::vector<Vec3> nearest_m; ///< Nearest points; valid if the distance is finite.
    std::uint64_t hash{0};       ///< Hash of the distances' bits, so that they are used.
    /// Allocations of all questions; empty if they are not counted.
    std::optional<std::uint64_t> allocations;
};

/// Asks all questions in turn, each with its own band, `passes` times. The first question is asked
/// once before, as in a running loop. A failure only if passes differ.
[[nodiscard]] PointAnswers replay_queries(TouchQuery& query, std::span<const Vec3> points_m,
                                          std::span<const double> bands_m, std::uint32_t passes);

/// Errors about touch: a sphere touches if the distance of its centre is below its radius.
struct TouchErrors
{
    std::uint64_t missed{0};   ///< Touches that the answer denies.
    std::uint64_t invented{0}; ///< Touches that the answer invents.

    TouchErrors& operator+=(const TouchErrors& other)
    {
        missed += other.missed;
        invented += other.invented;
        return *this;
    }
};
/// Counts the errors; either answer is right within `tolerance_m` of the radius. An answer that is
/// not a number denies a touch.
[[nodiscard]] TouchErrors judge_touch(std::span<const double> answers_m,
                                      std::span<const double> truth_m, double radius_m,
                                      double tolerance_m);

/// Greatest error of a distance; distances beyond the band count as the band. Infinite for an
/// answer that is not a number.
[[nodiscard]] double largest_error_m(std::span<const double> answers_m,
                                     std::span<const double> truth_m,
                                     std::span<const double> bands_m);

/// Greatest error of the nearest points: their distance from the surface, and their distance from
/// the question's point. Any of several equally near points is right.
[[nodiscard]] double largest_point_error_m(const PointAnswers& answers, const Questions& questions,
                                           const test::FaceTree& tree);

/// Contestant with the cost of its construction.
struct BuiltQuery
{
    std::unique_ptr<TouchQuery> query;
    double build_ms{0.0};
    double bytes{0.0};
};
/// Builds a peer; throws the peer's exception if it refuses the mesh.
[[nodiscard]] BuiltQuery build_peer(const PointPeer& peer, const std::vector<test::Face>& faces,
                                    double radius_m);

} // namespace tactus::bench
