// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/records/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace tactus
{

[[nodiscard]] inline Vec3 unit_or_zero(const Vec3& v) noexcept
{
    const double length = v.norm();
    return length > 0.0 ? Vec3(v / length) : Vec3(0.0, 0.0, 0.0);
}

/// Unit normal of a triangle; zero for a triangle without area.
[[nodiscard]] inline Vec3 normal_of(const Triangle& triangle) noexcept
{
    const double longest_sq = std::max({(triangle[1] - triangle[0]).squaredNorm(),
                                        (triangle[2] - triangle[1]).squaredNorm(),
                                        (triangle[0] - triangle[2]).squaredNorm()});
    return unit_or_zero(exact_normal(triangle, longest_sq));
}

[[nodiscard]] inline Contact make_contact(const ClosestPoints& closest, const Triangle& triangle,
                                          FaceId face, FaceId tool_face = {}) noexcept
{
    const bool is_apart = closest.distance > closest.distance_error;
    return {face,
            closest.feature,
            closest.distance,
            closest.on_shape,
            closest.on_triangle,
            is_apart ? unit_or_zero(-closest.gap) : normal_of(triangle),
            tool_face};
}

[[nodiscard]] inline bool comes_before(const Contact& a, const Contact& b) noexcept
{
    return std::tie(a.distance_m, a.face, a.tool_face) <
           std::tie(b.distance_m, b.face, b.tool_face);
}

/// Inserts a contact in order. If the set is full, drops the farthest contact and returns false.
[[nodiscard]] inline bool keep_nearest(const Contact& contact, ContactSet& contacts) noexcept
{
    TACTUS_ASSERT(!std::isnan(contact.distance_m)); // NaN would have no order.
    const bool is_full = contacts.size() == kMaxContacts;
    if (is_full && !comes_before(contact, contacts[kMaxContacts - 1]))
    {
        return false;
    }
    if (is_full)
    {
        contacts.pop_back();
    }
    contacts.push_back(contact);
    for (std::size_t i = contacts.size() - 1; i > 0 && comes_before(contacts[i], contacts[i - 1]);
         --i)
    {
        std::swap(contacts[i], contacts[i - 1]);
    }
    return !is_full;
}

/// Heights of a point along the first half of the directions of ContactEnds; the other half are
/// opposite. Directions have coordinates -1, 0 or 1 and are enumerated with x changing first, up to
/// (0, 0, 0), which is left out.
using EndHeights = std::array<double, kContactDirections / 2>;
inline constexpr double kEdgeEnd = std::numbers::sqrt2;
inline constexpr double kCornerEnd = std::numbers::sqrt3;
inline constexpr EndHeights kEndLengths{kCornerEnd, kEdgeEnd,   kCornerEnd, kEdgeEnd,   1.0,
                                        kEdgeEnd,   kCornerEnd, kEdgeEnd,   kCornerEnd, kEdgeEnd,
                                        1.0,        kEdgeEnd,   1.0};

/// Returns a point's height along each of these directions, times the direction's length.
[[nodiscard]] inline EndHeights end_heights(const Vec3& point_m) noexcept
{
    const double x = point_m[0];
    const double y = point_m[1];
    const double z = point_m[2];
    const double first = -y - z;
    const double third = y - z;
    return {first - x, first,     first + x, -z - x, -z,     -z + x, third - x,
            third,     third + x, -y - x,    -y,     -y + x, -x};
}
[[nodiscard]] constexpr std::size_t opposite_end(std::size_t direction) noexcept
{
    return kContactDirections - 1 - direction;
}
inline constexpr double kEndPerDistance = 10.0;

/// Keeps `contact` as an end in each direction in which it is the farthest. The first by
/// comes_before() of equally far contacts is kept, in any order of calls.
inline void keep_ends(const Contact& contact, ContactEnds& ends) noexcept
{
    const double less_m = kEndPerDistance * contact.distance_m;
    const auto keep = [&contact, &ends](std::size_t direction, double reach_m)
    {
        double& most_m = ends.reaches_m[direction];
        Contact& kept = ends.contacts[direction];
        if (ends.is_empty || reach_m > most_m || (reach_m == most_m && comes_before(contact, kept)))
        {
            most_m = reach_m;
            kept = contact;
        }
    };
    const EndHeights heights_m = end_heights(contact.on_surface_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i)
    {
        const double height_m = heights_m[i] / kEndLengths[i];
        keep(i, height_m - less_m);
        keep(opposite_end(i), -height_m - less_m);
    }
    ends.is_empty = false;
}

/// Reach of a contact in each direction: its height less kEndPerDistance x its distance.
using EndReaches = std::array<double, kContactDirections>;

/// Allowance for rounding of a contact's place, distance and reach; many times the actual error.
inline constexpr double kEndRounding = 1e-12;

/// Upper bounds on the reaches of contacts on a triangle that is at least `distance_m` from the
/// core.
[[nodiscard]] inline EndReaches most_end_reaches(const Triangle& triangle,
                                                 double distance_m) noexcept
{
    double size_m = distance_m;
    for (const Vec3& corner : triangle)
    {
        size_m = std::max({size_m, std::abs(corner[0]), std::abs(corner[1]), std::abs(corner[2])});
    }
    const double more_m = kEndRounding * size_m - kEndPerDistance * distance_m;
    const EndHeights a = end_heights(triangle[0]);
    const EndHeights b = end_heights(triangle[1]);
    const EndHeights c = end_heights(triangle[2]);
    EndReaches reaches_m; // NOLINT(cppcoreguidelines-pro-type-member-init): the loop fills it.
    for (std::size_t i = 0; i < kEndLengths.size(); ++i)
    {
        reaches_m[i] = std::max({a[i], b[i], c[i]}) / kEndLengths[i] + more_m;
        reaches_m[opposite_end(i)] = -std::min({a[i], b[i], c[i]}) / kEndLengths[i] + more_m;
    }
    return reaches_m;
}

/// True if `a` is at least as far as `b` in any direction.
[[nodiscard]] inline bool is_farther_in_any(const EndReaches& a, const EndReaches& b) noexcept
{
    bool is_farther = false;
    for (std::size_t i = 0; i < a.size(); ++i) // No early exit, for all directions at once.
    {
        is_farther |= a[i] >= b[i];
    }
    return is_farther;
}

/// Cheap test before is_farther_in_any() for most_end_reaches() of a triangle whose points are
/// within `size_m` of its first corner: false only if that is false. Takes a fifth of the work.
[[nodiscard]] inline bool may_be_farther_in_any(const Triangle& triangle, double size_m,
                                                double distance_m,
                                                const EndReaches& reaches_m) noexcept
{
    const double place_m = size_m + distance_m + triangle[0].cwiseAbs().sum();
    const double more_m = size_m + 4.0 * kEndRounding * place_m - kEndPerDistance * distance_m;
    const EndHeights heights_m = end_heights(triangle[0]);
    bool may_be = false;
    for (std::size_t i = 0; i < heights_m.size(); ++i) // No early exit, for all directions at once.
    {
        const double height_m = heights_m[i] * (1.0 / kEndLengths[i]);
        may_be |= more_m + height_m >= reaches_m[i];
        may_be |= more_m - height_m >= reaches_m[opposite_end(i)];
    }
    return may_be;
}

/// Adds a face to the slab with the most similar normal, or to a new slab. A face without a normal
/// makes the slab cover all directions.
inline void keep_slab(const Vec3& normal, double distance_m, TouchReport& touches) noexcept
{
    constexpr double kSameSlab = 0.05;
    constexpr double kAnyDirection = 2.0;
    const bool has_none = normal == Vec3(0.0, 0.0, 0.0);
    ContactSlab* best = nullptr;
    double least = kInfinity;
    for (ContactSlab& slab : touches.slabs)
    {
        const double apart = (slab.normal - normal).norm();
        best = apart < least ? &slab : best;
        least = std::min(least, apart);
    }
    if (!touches.slabs.full() && !(least <= kSameSlab))
    {
        touches.slabs.push_back({normal, distance_m, has_none ? kAnyDirection : 0.0});
        return;
    }
    TACTUS_ASSERT(best != nullptr);
    best->distance_m = std::min(best->distance_m, distance_m);
    best->spread = std::max(best->spread, has_none ? kAnyDirection : least);
}

} // namespace tactus
