// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/double_double.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/math/triple.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

namespace tactus
{

/// Rounding of one operation in `Real`: half a unit in the last place.
template <typename Real>
inline constexpr double kRounding = std::same_as<Real, double> ? 0x1p-53 : 0x1p-102;

/// Distance from the origin that double can't tell from zero, in lengths of the operands of the
/// simplex's points. A tetrahedron counts as holding the origin if the weighted sum of its points
/// is this near.
inline constexpr double kSimplexTouching = 8.0 * kRounding<double>;

/// Foot: the point of a simplex nearest to the origin.
template <typename Real>
struct SimplexFoot
{
    /// Weights of the simplex's points, with a sum of 1. None is negative; zero for points that
    /// aren't corners of the feature that holds the foot.
    std::array<Real, 4> weights{};
    /// Weighted sum of the points, so in the simplex for any weights.
    Triple<Real> foot{};
    Real distance_sq{0.0};
    /// Normal of the feature that holds the foot, away from the origin, of any length. It is
    /// correct even if the foot is so near to the origin that its own direction is lost to
    /// rounding.
    Triple<Real> across{};
    std::size_t corners{0};
};

/// Finds the foot of a simplex of one to four points: the nearest one of the feet of all its
/// features, with the largest features first. A tetrahedron's inside has a foot only if it holds
/// the origin.
///
/// A face or edge has a foot if all its weights are positive. Weights are ratios of areas and
/// lengths and identify the feature better than the distances, whose squares differ little beside
/// an edge. So a smaller feature is taken only if it is nearer by more than rounding.
template <typename Real>
class SimplexSolver
{
public:
    using Point = Triple<Real>;

    /// `length` is that of the operands from which the points were made, and sets their rounding.
    SimplexSolver(std::span<const Point> points, double length) noexcept
        : points_(points)
        , noise_(8.0 * kRounding<Real> * length)
        , touching_(kSimplexTouching * length)
    {
    }

    /// Returns the foot of the simplex; `with_last_only` leaves out features without the last
    /// point.
    [[nodiscard]] SimplexFoot<Real> find(bool with_last_only) noexcept
    {
        const std::size_t count = points_.size();
        TACTUS_ASSERT(count > 0);
        TACTUS_ASSERT(count <= 4);
        const std::size_t last = count - 1;
        if (count == 4)
        {
            try_inside();
        }
        for (std::size_t k = with_last_only ? last : 0; k < count; ++k)
        {
            for (std::size_t j = 0; j < k; ++j)
            {
                for (std::size_t i = 0; i < j; ++i)
                {
                    try_face(i, j, k);
                }
            }
        }
        for (std::size_t k = with_last_only ? last : 0; k < count; ++k)
        {
            for (std::size_t j = 0; j < k; ++j)
            {
                try_edge(j, k);
            }
        }
        for (std::size_t k = with_last_only ? last : 0; k < count; ++k)
        {
            try_corner(k);
        }
        TACTUS_ASSERT(best_.corners > 0);
        return best_;
    }

private:
    using Weights = std::array<Real, 4>;

    [[nodiscard]] static bool is_positive(const Real& value) noexcept { return value > Real{0.0}; }

    void try_corner(std::size_t i) noexcept
    {
        Weights weights{};
        weights[i] = Real{1.0};
        keep_if_nearer(weights, points_[i], points_[i], 1);
    }

    void try_edge(std::size_t i, std::size_t j) noexcept
    {
        const Point edge = points_[j] - points_[i];
        const Real length_sq = dot(edge, edge);
        const Real from_i = -dot(points_[i], edge);
        const Real from_j = dot(points_[j], edge);
        if (!is_positive(from_i) || !is_positive(from_j) || !is_positive(length_sq))
        {
            return;
        }
        Weights weights{};
        weights[j] = from_i / length_sq;
        weights[i] = Real{1.0} - weights[j];
        const Point foot = weights[i] * points_[i] + weights[j] * points_[j];
        keep_if_nearer(weights, foot, foot - (dot(foot, edge) / length_sq) * edge, 2);
    }

    void try_face(std::size_t i, std::size_t j, std::size_t k) noexcept
    {
        const std::array<std::size_t, 3> corner{i, j, k};
        const std::array<Point, 3> edge{points_[j] - points_[i], points_[k] - points_[j],
                                        points_[i] - points_[k]};
        const Point normal = cross(edge[0], edge[1]);
        if (!(dot(normal, normal) > Real{kLeastTrustedNormalSq}))
        {
            return;
        }
        Weights weights{};
        Real sum{0.0};
        for (std::size_t side = 0; side < 3; ++side)
        {
            // Weight of the corner opposite this side: how far the origin is inside of the side.
            const Real inside = dot(cross(edge[side], normal), points_[corner[side]]);
            if (!is_positive(inside))
            {
                return;
            }
            weights[corner[(side + 2) % 3]] = inside;
            sum = sum + inside;
        }
        for (const std::size_t at : corner)
        {
            weights[at] = weights[at] / sum;
        }
        const Point foot =
            weights[i] * points_[i] + weights[j] * points_[j] + weights[k] * points_[k];
        const Real height = dot(points_[i], normal);
        keep_if_nearer(weights, foot, height < Real{0.0} ? -normal : normal, 3);
    }

    /// Tries the inside of a tetrahedron: it holds the origin if the volumes opposite the corners
    /// have one sign. The volumes of flat tetrahedra are noise; the weighted sum of their points
    /// then is not zero.
    void try_inside() noexcept
    {
        const Point front = cross(points_[0], points_[1]);
        const Point back = cross(points_[2], points_[3]);
        Weights weights{dot(points_[1], back), -dot(points_[0], back), dot(points_[3], front),
                        -dot(points_[2], front)};
        const Real sum = weights[0] + weights[1] + weights[2] + weights[3];
        for (Real& weight : weights)
        {
            weight = is_positive(sum) ? weight : -weight;
            if (!is_positive(weight))
            {
                return;
            }
        }
        const Real size = is_positive(sum) ? sum : -sum;
        Point foot{};
        for (std::size_t i = 0; i < 4; ++i)
        {
            weights[i] = weights[i] / size;
            foot = foot + weights[i] * points_[i];
        }
        if (to_double(dot(foot, foot)) <= touching_ * touching_)
        {
            keep_if_nearer(weights, foot, foot, 4);
        }
    }

    void keep_if_nearer(const Weights& weights, const Point& foot, const Point& across,
                        std::size_t corners) noexcept
    {
        const Real distance_sq = dot(foot, foot);
        if (best_.corners == 0 || distance_sq + Real{tie_} < best_.distance_sq)
        {
            best_ = {weights, foot, distance_sq, across, corners};
            tie_ = noise_ * (std::abs(to_double(foot.x)) + std::abs(to_double(foot.y)) +
                             std::abs(to_double(foot.z)));
        }
    }

    std::span<const Point> points_;
    double noise_;    ///< Bound on the rounding of a coordinate that is zero.
    double touching_; ///< Distances up to this count as zero.
    double tie_{0.0};
    SimplexFoot<Real> best_{};
};

} // namespace tactus
