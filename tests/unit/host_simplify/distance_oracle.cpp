// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_simplify/distance_oracle.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test
{

namespace
{

LongPoint minus(const LongPoint& a, const LongPoint& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

long double dot(const LongPoint& a, const LongPoint& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

long double length(const LongPoint& a)
{
    return std::sqrt(dot(a, a));
}

long double distance_to_segment(const LongPoint& p, const LongPoint& a, const LongPoint& b)
{
    const LongPoint ab = minus(b, a);
    const LongPoint ap = minus(p, a);
    const long double squared = dot(ab, ab);
    const long double t = squared > 0 ? std::clamp(dot(ap, ab) / squared, 0.0L, 1.0L) : 0;
    return length(minus(ap, {t * ab[0], t * ab[1], t * ab[2]}));
}

} // namespace

long double oracle_distance(const LongPoint& point, const std::array<LongPoint, 3>& triangle)
{
    const auto& [a, b, c] = triangle;
    const long double sides =
        std::min({distance_to_segment(point, a, b), distance_to_segment(point, b, c),
                  distance_to_segment(point, c, a)});
    // Foot a + s ab + t ac by the normal equations.
    const LongPoint ab = minus(b, a);
    const LongPoint ac = minus(c, a);
    const LongPoint ap = minus(point, a);
    const long double ab_ab = dot(ab, ab);
    const long double ab_ac = dot(ab, ac);
    const long double ac_ac = dot(ac, ac);
    const long double determinant = ab_ab * ac_ac - ab_ac * ab_ac;
    if (determinant <= 0)
    {
        return sides;
    }
    const long double s = (dot(ap, ab) * ac_ac - dot(ap, ac) * ab_ac) / determinant;
    const long double t = (dot(ap, ac) * ab_ab - dot(ap, ab) * ab_ac) / determinant;
    if (s < 0 || t < 0 || s + t > 1)
    {
        return sides;
    }
    const LongPoint foot{s * ab[0] + t * ac[0], s * ab[1] + t * ac[1], s * ab[2] + t * ac[2]};
    return std::min(sides, length(minus(ap, foot)));
}

long double searched_distance(const LongPoint& point, const std::array<LongPoint, 3>& triangle)
{
    const LongPoint a = triangle[0];
    const LongPoint b = triangle[1];
    const LongPoint c = triangle[2];
    const auto at = [&](long double share)
    {
        LongPoint left{};
        LongPoint right{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            left[axis] = a[axis] + share * (b[axis] - a[axis]);
            right[axis] = a[axis] + share * (c[axis] - a[axis]);
        }
        return distance_to_segment(point, left, right);
    };
    long double low = 0;
    long double high = 1;
    for (int step = 0; step < 150; ++step)
    {
        const long double third = (high - low) / 3;
        if (at(low + third) < at(high - third))
        {
            high -= third;
        }
        else
        {
            low += third;
        }
    }
    return std::min({at(low), at(0), at(1)});
}

} // namespace tactus::test
