// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Answer of a contestant for one point, in the model frame.
struct SurfaceAnswer
{
    double distance_m{0.0}; ///< Distance; not finite if nothing is within the contestant's band.
    Vec3 nearest_m{0.0, 0.0, 0.0};
    bool has_nearest{false};
};
/// Answer of Tactus: the proven nearest point, or the middle of the bounds.
[[nodiscard]] SurfaceAnswer answer_of(const PairOutput& pair);
/// Answers of a peer, one for each question.
[[nodiscard]] std::vector<SurfaceAnswer> answers_of(const PointAnswers& answers);

/// Errors of answers against the truth.
struct AnswerErrors
{
    Spread distance_diag; ///< Errors of the distance, see TrueAnswers::errors_of().
    Spread normal_deg;    ///< Errors of the normal, of answers with a nearest point.
    /// Errors of the force of a penalty spring, 500 N/m on an object of 0.2 m. An answer without a
    /// nearest point has no force.
    Spread force_n;
    TouchErrors touch;
    std::uint64_t hash{0}; ///< Hash of the answers' bits.
};

/// Points of a motion with the true distances and nearest points of the whole mesh.
class TrueAnswers
{
public:
    TrueAnswers(const test::FaceTree& tree, double diagonal_m, std::vector<Vec3> points_m,
                double radius_m);

    [[nodiscard]] const Questions& questions() const { return questions_; }
    [[nodiscard]] double radius_m() const { return radius_m_; }
    /// Errors of one answer for each point. Distances beyond the radius, also true ones, count as
    /// the radius: only the penetration depth is judged.
    [[nodiscard]] AnswerErrors errors_of(const std::vector<SurfaceAnswer>& answers) const;

private:
    [[nodiscard]] Vec3 force_n(std::size_t point, const SurfaceAnswer& answer) const;

    Questions questions_;
    std::vector<SurfaceAnswer> truth_;
    double radius_m_;
    double diagonal_m_;
};

} // namespace tactus::bench
