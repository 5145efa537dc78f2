// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::bench
{

/// What a contestant says of one point, model frame.
struct SurfaceAnswer
{
    double distance_m{0.0};
    std::optional<Vec3> nearest_m; ///< None: it doesn't know where.
};

/// Ours: the proven distance, or the middle of a bracket.
[[nodiscard]] SurfaceAnswer answer_of(const PairOutput& pair);

/// How far answers are from the truth.
struct AnswerErrors
{
    Spread distance_diag;
    Spread normal_deg; ///< Of answers that know where.
    /// Of the force of a penalty spring, 500 N/m, on an object of 0.2 m; without knowing where
    /// there is no force.
    Spread force_n;
    std::uint64_t missed{0};   ///< Contacts that were not seen,
    std::uint64_t invented{0}; ///< or seen where there is none, by more than rounding.
    std::uint64_t hash{0};     ///< Over the answers' bits.
};

/// Points of a motion, their true distances and nearest points: of the whole mesh.
class TrueAnswers
{
public:
    TrueAnswers(const Scene& scene, std::vector<Vec3> points_m, double radius_m);

    [[nodiscard]] const std::vector<Vec3>& points_m() const { return points_m_; }
    /// `answers`: one a point.
    [[nodiscard]] AnswerErrors errors_of(const std::vector<SurfaceAnswer>& answers) const;

private:
    [[nodiscard]] Vec3 force_n(const Vec3& point_m, const SurfaceAnswer& answer) const;

    std::vector<Vec3> points_m_;
    std::vector<SurfaceAnswer> truth_;
    double radius_m_;
    double diagonal_m_;
};

} // namespace tactus::bench
