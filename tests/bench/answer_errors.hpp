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

/// What a contestant says of one point, model frame.
struct SurfaceAnswer
{
    double distance_m{0.0}; ///< Not finite: none within its band.
    Vec3 nearest_m{0.0, 0.0, 0.0};
    bool has_nearest{false};
};
/// Ours: the proven nearest point, or the middle of a bracket.
[[nodiscard]] SurfaceAnswer answer_of(const PairOutput& pair);
/// A peer's, one a question.
[[nodiscard]] std::vector<SurfaceAnswer> answers_of(const PointAnswers& answers);

/// How far answers are from the truth.
struct AnswerErrors
{
    Spread distance_diag; ///< As TrueAnswers::errors_of has it.
    Spread normal_deg;    ///< Of answers that tell a nearest point.
    /// Of the force of a penalty spring, 500 N/m on an object of 0.2 m. Whoever knows no nearest
    /// point has no force.
    Spread force_n;
    TouchErrors touch;
    std::uint64_t hash{0}; ///< Over the answers' bits.
};

/// Points of a motion with the true distances and nearest points, those of the whole mesh.
class TrueAnswers
{
public:
    TrueAnswers(const test::FaceTree& tree, double diagonal_m, std::vector<Vec3> points_m,
                double radius_m);

    [[nodiscard]] const Questions& questions() const { return questions_; }
    [[nodiscard]] double radius_m() const { return radius_m_; }
    /// One answer a point. Distances count as the radius where they are beyond it, the truth, too:
    /// what is judged is how deep the tool is in.
    [[nodiscard]] AnswerErrors errors_of(const std::vector<SurfaceAnswer>& answers) const;

private:
    [[nodiscard]] Vec3 force_n(std::size_t point, const SurfaceAnswer& answer) const;

    Questions questions_;
    std::vector<SurfaceAnswer> truth_;
    double radius_m_;
    double diagonal_m_;
};

} // namespace tactus::bench
