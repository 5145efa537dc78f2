// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/gjk.hpp"
#include "rt_core/math/safe_scale.hpp"
#include "tests/unit/geometry/hull_oracle.hpp"
#include "tests/unit/geometry/hull_scenes.hpp"

#include <cmath>
#include <string>

namespace tactus::test
{

/// Distance that the wider numbers may leave between meeting shapes, in local lengths, if one is
/// thin.
inline constexpr double kTouching = 1e-17;

/// Cases of each class of pairs; a million in all for any number of kernel cases.
[[nodiscard]] inline int convex_cases_per_class()
{
    return std::min(cases_per_class(), 70'000);
}

/// Hull of a scene, which refers to the vertices.
[[nodiscard]] inline Hull hull_of(const std::vector<Vec3>& vertices)
{
    return Hull::create(vertices).value();
}

/// Radius and greatest distance of a corner from the centre.
[[nodiscard]] inline double local_length(const ConvexBody& body, const Triangle& triangle)
{
    return body.radius +
           std::max({(triangle[0] - body.center).norm(), (triangle[1] - body.center).norm(),
                     (triangle[2] - body.center).norm()});
}

/// Fault of the bounds if the distance is `truth`; empty if they hold it.
[[nodiscard]] inline std::string broken_bound(const GjkAnswer& answer, Quad truth, double length)
{
    const auto slack = static_cast<Quad>(kTouching * length);
    if (!(static_cast<Quad>(answer.lower) <= truth + slack))
    {
        return "the lower bound is above the distance";
    }
    if (!(static_cast<Quad>(answer.upper) >= truth - slack))
    {
        return "the upper bound is below the distance";
    }
    return "";
}

/// Width of the bounds, in units of the error law.
[[nodiscard]] inline double share_of_law(const GjkAnswer& answer, double length)
{
    const double apart = answer.upper - answer.lower;
    return apart == 0.0 ? 0.0 : apart / (1e-12 * answer.upper + 1e-14 * length);
}

[[nodiscard]] inline bool is_finite(const GjkAnswer& answer)
{
    return answer.on_body.allFinite() && answer.on_triangle.allFinite() && answer.gap.allFinite() &&
           std::isfinite(answer.upper) && std::isfinite(answer.lower);
}

/// Eight corners of a box at the origin.
[[nodiscard]] inline std::vector<Vec3> corners_of(const Box& box)
{
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < 8; ++i)
    {
        corners.push_back(box.half.cwiseProduct(
            Vec3((i & 1U) == 0 ? 1 : -1, (i & 2U) == 0 ? 1 : -1, (i & 4U) == 0 ? 1 : -1)));
    }
    return corners;
}

/// Points within a radius of a segment, as a convex body: the segment of a sphere has no length.
struct RoundCore
{
    explicit RoundCore(const Capsule& capsule)
        : half_(0.5 * (capsule.core.to - capsule.core.from))
        , radius_(capsule.radius)
        , center_(0.5 * (capsule.core.to + capsule.core.from))
    {
    }

    [[nodiscard]] ConvexBody body() const
    {
        return {&support, this, center_, (radius_ + half_.norm()) * (1.0 + 1e-15)};
    }

private:
    static Vec3 support(const void* context, const Vec3& direction) noexcept TACTUS_NONBLOCKING
    {
        const auto& self = *static_cast<const RoundCore*>(context);
        const Vec3 end = direction.dot(self.half_) < 0.0 ? Vec3(-self.half_) : self.half_;
        return end + direction * self.radius_;
    }

    Vec3 half_;
    double radius_;
    Vec3 center_;
};

} // namespace tactus::test
