// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/answer_errors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr double kObject_m = 0.2;
constexpr double kStiffness_n_per_m = 500.0;
/// Answers within this of the radius may report a touch or not.
constexpr double kTolerance_diag = 2e-6;
/// Closer to the surface, the direction of an answer has no meaning.
constexpr double kNoDirection_diag = 1e-4;

double angle_deg(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

} // namespace

SurfaceAnswer answer_of(const PairOutput& pair)
{
    if (!pair.nearest_face.is_none())
    {
        return {(pair.point_m - pair.nearest_point_m).norm(), pair.nearest_point_m, true};
    }
    const bool is_bounded = std::isfinite(pair.upper_m);
    return {is_bounded ? 0.5 * (pair.lower_m + pair.upper_m) : pair.lower_m, Vec3(0.0, 0.0, 0.0),
            false};
}

std::vector<SurfaceAnswer> answers_of(const PointAnswers& answers)
{
    std::vector<SurfaceAnswer> all;
    for (std::size_t i = 0; i < answers.distances_m.size(); ++i)
    {
        const double distance_m = answers.distances_m[i];
        all.push_back({distance_m, answers.nearest_m[i], std::isfinite(distance_m)});
    }
    return all;
}

TrueAnswers::TrueAnswers(const test::FaceTree& tree, double diagonal_m, std::vector<Vec3> points_m,
                         double radius_m)
    : radius_m_(radius_m), diagonal_m_(diagonal_m)
{
    questions_.points_m = std::move(points_m);
    for (const Vec3& point_m : questions_.points_m)
    {
        const auto nearest = tree.nearest(point_m);
        truth_.push_back({nearest.distance_m, nearest.point_m, true});
        questions_.truth_m.push_back(nearest.distance_m);
    }
}

AnswerErrors TrueAnswers::errors_of(const std::vector<SurfaceAnswer>& answers) const
{
    AnswerErrors errors;
    std::vector<double> distances_m;
    std::vector<double> off_diag;
    std::vector<double> normals_deg;
    std::vector<double> forces_n;
    for (std::size_t i = 0; i < truth_.size(); ++i)
    {
        const SurfaceAnswer& truth = truth_[i];
        const SurfaceAnswer& answer = answers[i];
        distances_m.push_back(answer.distance_m);
        off_diag.push_back(std::abs(std::min(answer.distance_m, radius_m_) -
                                    std::min(truth.distance_m, radius_m_)) /
                           diagonal_m_);
        if (answer.has_nearest && truth.distance_m > kNoDirection_diag * diagonal_m_)
        {
            const Vec3& point_m = questions_.points_m[i];
            normals_deg.push_back(angle_deg(point_m - answer.nearest_m, point_m - truth.nearest_m));
        }
        forces_n.push_back((force_n(i, answer) - force_n(i, truth)).norm());
        errors.hash += std::bit_cast<std::uint64_t>(answer.distance_m) * (2 * i + 1);
    }
    errors.distance_diag = spread_of(off_diag);
    errors.normal_deg = spread_of(normals_deg);
    errors.force_n = spread_of(forces_n);
    errors.touch =
        judge_touch(distances_m, questions_.truth_m, radius_m_, kTolerance_diag * diagonal_m_);
    return errors;
}

Vec3 TrueAnswers::force_n(std::size_t point, const SurfaceAnswer& answer) const
{
    const double depth_m = radius_m_ - answer.distance_m;
    if (!answer.has_nearest || !(depth_m > 0.0) || !(answer.distance_m > 0.0))
    {
        return {0.0, 0.0, 0.0};
    }
    const Vec3 outward = (questions_.points_m[point] - answer.nearest_m) / answer.distance_m;
    return outward * (kStiffness_n_per_m * depth_m * kObject_m / diagonal_m_);
}

} // namespace tactus::bench
