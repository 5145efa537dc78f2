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
/// Contacts are only missed or invented by more than this.
constexpr double kTolerance_diag = 2e-6;
/// Nearer to the surface than this a direction from it means nothing.
constexpr double kNoDirection_diag = 1e-4;

double angle_deg(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

} // namespace

SurfaceAnswer answer_of(const PairOutput& pair)
{
    SurfaceAnswer answer;
    answer.distance_m =
        std::isfinite(pair.upper_m) ? std::midpoint(pair.lower_m, pair.upper_m) : pair.lower_m;
    if (!pair.nearest_face.is_none())
    {
        answer.nearest_m = pair.nearest_point_m;
        answer.distance_m = (pair.point_m - pair.nearest_point_m).norm();
    }
    return answer;
}

TrueAnswers::TrueAnswers(const Scene& scene, std::vector<Vec3> points_m, double radius_m)
    : points_m_(std::move(points_m)), radius_m_(radius_m), diagonal_m_(scene.model.diagonal_m)
{
    for (const Vec3& point_m : points_m_)
    {
        const auto nearest = scene.tree->nearest(point_m);
        truth_.push_back({nearest.distance_m, nearest.point_m});
    }
}

AnswerErrors TrueAnswers::errors_of(const std::vector<SurfaceAnswer>& answers) const
{
    AnswerErrors errors;
    std::vector<double> distances;
    std::vector<double> normals;
    std::vector<double> forces;
    const double tolerance_m = kTolerance_diag * diagonal_m_;
    for (std::size_t i = 0; i < points_m_.size(); ++i)
    {
        const SurfaceAnswer& truth = truth_[i];
        const SurfaceAnswer& answer = answers[i];
        distances.push_back(std::abs(answer.distance_m - truth.distance_m) / diagonal_m_);
        if (answer.nearest_m && truth.distance_m > kNoDirection_diag * diagonal_m_)
        {
            normals.push_back(
                angle_deg(points_m_[i] - *answer.nearest_m, points_m_[i] - *truth.nearest_m));
        }
        forces.push_back(
            (force_n(points_m_[i], answer) - force_n(points_m_[i], truth)).norm());
        const bool touches = truth.distance_m < radius_m_;
        const bool seems_to = answer.distance_m < radius_m_;
        const bool is_clear = std::abs(truth.distance_m - radius_m_) > tolerance_m;
        errors.missed += is_clear && touches && !seems_to ? 1U : 0U;
        errors.invented += is_clear && !touches && seems_to ? 1U : 0U;
        errors.hash += std::bit_cast<std::uint64_t>(answer.distance_m) * (2 * i + 1);
    }
    errors.distance_diag = spread_of(distances);
    errors.normal_deg = spread_of(normals);
    errors.force_n = spread_of(forces);
    return errors;
}

Vec3 TrueAnswers::force_n(const Vec3& point_m, const SurfaceAnswer& answer) const
{
    const double depth_m = radius_m_ - answer.distance_m;
    if (!answer.nearest_m || depth_m <= 0.0 || answer.distance_m <= 0.0)
    {
        return Vec3(0.0, 0.0, 0.0);
    }
    const Vec3 outward = (point_m - *answer.nearest_m) / answer.distance_m;
    return outward * (kStiffness_n_per_m * depth_m * kObject_m / diagonal_m_);
}

} // namespace tactus::bench
