// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/gjk.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/simplex.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/direction.hpp"
#include "rt_core/math/safe_scale.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

// A tetrahedron that holds the origin ends the search, so a simplex never has more than four
// corners.
static_assert(kGjkRounding > 2.0 * kSimplexTouching);

/// Farthest points of body and triangle along one direction; a corner of the simplex is their
/// difference.
struct SupportPair
{
    Vec3 on_body;
    std::uint32_t corner; ///< Corner of the triangle.

    friend bool operator==(const SupportPair& a, const SupportPair& b) noexcept
    {
        return a.corner == b.corner && a.on_body == b.on_body;
    }
};

Triangle seen_from(const Vec3& center, const Triangle& triangle) noexcept
{
    return {triangle[0] - center, triangle[1] - center, triangle[2] - center};
}

/// State of one query, relative to the body's centre and multiplied by a power of two, so that
/// products of coordinates stay in the range of double.
class Gjk
{
public:
    Gjk(const ConvexBody& body, const Triangle& triangle, double scale, double limit) noexcept
        : body_(body)
        , triangle_(scaled(triangle, scale))
        , scale_(scale)
        , limit_(limit * scale)
        , length_(body.radius * scale +
                  std::max({triangle_[0].norm(), triangle_[1].norm(), triangle_[2].norm()}))
        , rounding_(kGjkRounding * length_)
    {
        TACTUS_ASSERT(body.support != nullptr);
        TACTUS_ASSERT(body.radius >= 0.0);
        TACTUS_ASSERT(limit >= 0.0);
    }

    [[nodiscard]] GjkAnswer find(Vec3& direction) noexcept
    {
        start(direction);
        approach<double>();
        if (!is_near_enough())
        {
            approach<DoubleDouble>();
        }
        direction = lower_direction_;
        return answer();
    }

private:
    void start(const Vec3& direction) noexcept
    {
        Vec3 way = direction;
        if (!has_direction(way))
        {
            way = closest_point_on_triangle(Vec3(0.0, 0.0, 0.0), triangle_).gap;
        }
        simplex_.push_back(find_support(has_direction(way) ? unit_of(way) : Vec3(1.0, 0.0, 0.0)));
        weights_[0] = 1.0;
        gap_ = difference_of(simplex_[0]);
        distance_ = gap_.norm();
    }

    /// Iterates until the bounds are near enough, or their difference is only rounding of `Real`.
    template <typename Real>
    void approach() noexcept
    {
        SimplexFoot<Real> foot = solve<Real>(false);
        keep(foot);
        while (!is_near_enough() && iterations_ < kGjkIterations)
        {
            const Vec3 across = to_vec3(foot.across);
            if (!has_direction(across))
            {
                return;
            }
            const SupportPair farthest = find_support(unit_of(across));
            if (is_near_enough() || std::ranges::find(simplex_, farthest) != simplex_.end())
            {
                return;
            }
            simplex_.push_back(farthest);
            const SimplexFoot<Real> next = solve<Real>(true);
            if (!(next.distance_sq < foot.distance_sq))
            {
                simplex_.pop_back();
                return;
            }
            foot = next;
            keep(foot);
        }
    }

    /// Finds the farthest points along a direction, and raises the lower bound to their distance.
    [[nodiscard]] SupportPair find_support(const Vec3& direction) noexcept
    {
        ++iterations_;
        SupportPair farthest{body_.support(body_.context, direction) * scale_, 0};
        for (std::uint32_t i = 1; i < 3; ++i)
        {
            if (direction.dot(triangle_[i]) < direction.dot(triangle_[farthest.corner]))
            {
                farthest.corner = i;
            }
        }
        const double apart = direction.dot(difference_of(farthest));
        if (apart > lower_ || iterations_ == 1)
        {
            lower_ = apart;
            lower_direction_ = direction;
        }
        return farthest;
    }

    [[nodiscard]] Vec3 difference_of(const SupportPair& pair) const noexcept
    {
        return triangle_[pair.corner] - pair.on_body;
    }

    [[nodiscard]] bool is_near_enough() const noexcept
    {
        return distance_ <= rounding_ || lower_ - rounding_ > limit_ ||
               distance_ - lower_ <= kGjkRelativeGap * distance_ + rounding_;
    }

    template <typename Real>
    [[nodiscard]] SimplexFoot<Real> solve(bool with_last_only) const noexcept
    {
        StaticVector<Triple<Real>, 4> points;
        for (const SupportPair& pair : simplex_)
        {
            points.push_back(difference<Real>(triangle_[pair.corner], pair.on_body));
        }
        return SimplexSolver<Real>(points.view(), length_).find(with_last_only);
    }

    /// Keeps only the simplex's corners with a weight at the foot.
    template <typename Real>
    void keep(const SimplexFoot<Real>& foot) noexcept
    {
        const StaticVector<SupportPair, 4> all = simplex_;
        simplex_.clear();
        for (std::size_t i = 0; i < all.size(); ++i)
        {
            if (to_double(foot.weights[i]) > 0.0)
            {
                weights_[simplex_.size()] = to_double(foot.weights[i]);
                simplex_.push_back(all[i]);
            }
        }
        TACTUS_ASSERT(!simplex_.empty());
        gap_ = to_vec3(foot.foot);
        distance_ = gap_.norm();
    }

    /// True if zero is inside of the simplex in spite of its corners' rounding. An error of r in
    /// each corner changes the volume before a side by at most r x the areas that the edges span.
    [[nodiscard]] bool is_overlap_proven() const noexcept
    {
        if (simplex_.size() < 4)
        {
            return false;
        }
        const std::array<Vec3, 4> p{difference_of(simplex_[0]), difference_of(simplex_[1]),
                                    difference_of(simplex_[2]), difference_of(simplex_[3])};
        int sides = 0;
        for (std::size_t i = 0; i < 4; ++i)
        {
            const Vec3& a = p[(i + 1) % 4];
            const Vec3& b = p[(i + 2) % 4];
            const Vec3& c = p[(i + 3) % 4];
            const double volume = a.dot(b.cross(c));
            const double error =
                2.0 * rounding_ * (a.norm() * b.norm() + b.norm() * c.norm() + c.norm() * a.norm());
            const int turn = i % 2 == 0 ? 1 : -1;
            sides += volume > error ? turn : (volume < -error ? -turn : 0);
        }
        return std::abs(sides) == 4;
    }

    [[nodiscard]] GjkAnswer answer() const noexcept
    {
        const double inverse = 1.0 / scale_;
        GjkAnswer result;
        Vec3 on_body(0.0, 0.0, 0.0);
        Vec3 on_triangle(0.0, 0.0, 0.0);
        std::array<double, 3> corner_weights{};
        for (std::size_t i = 0; i < simplex_.size(); ++i)
        {
            on_body += weights_[i] * simplex_[i].on_body;
            on_triangle += weights_[i] * triangle_[simplex_[i].corner];
            corner_weights[simplex_[i].corner] += weights_[i];
        }
        result.on_body = body_.center + on_body * inverse;
        result.on_triangle = body_.center + on_triangle * inverse;
        result.gap = gap_ * inverse;
        result.upper = is_overlap_proven() ? 0.0 : (distance_ + rounding_) * inverse;
        result.lower = std::max(0.0, lower_ - rounding_) * inverse;
        result.rounding = rounding_ * inverse;
        result.iterations = iterations_;
        result.feature = feature_of(corner_weights);
        return result;
    }

    static TriangleFeature feature_of(const std::array<double, 3>& weights) noexcept
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const bool is_across = weights[(i + 2) % 3] > 0.0;
            const bool is_next = weights[(i + 1) % 3] > 0.0;
            if (weights[i] > 0.0 && !is_across)
            {
                return static_cast<TriangleFeature>(is_next ? 3 + i : i);
            }
        }
        return TriangleFeature::interior;
    }

    const ConvexBody& body_;
    Triangle triangle_;
    double scale_;
    double limit_;
    double length_; ///< Local length, the unit of the error law.
    double rounding_;
    StaticVector<SupportPair, 4> simplex_;
    std::array<double, 4> weights_{};
    Vec3 gap_{0.0, 0.0, 0.0};
    double distance_{0.0}; ///< Distance of the simplex from zero.
    /// Lower bound without an allowance for rounding; negative if no direction shows a distance.
    double lower_{0.0};
    Vec3 lower_direction_{0.0, 0.0, 0.0};
    std::uint32_t iterations_{0};
};

} // namespace

GjkAnswer gjk_distance(const ConvexBody& body, const Triangle& triangle, Vec3& direction,
                       double limit) noexcept
{
    const Triangle near = seen_from(body.center, triangle);
    const double scale = safe_scale(std::max(largest_coordinate(near), body.radius));
    return Gjk(body, near, scale, limit).find(direction);
}

} // namespace tactus
