// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/math/infinity.hpp"
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

/// Unit length; zero for a triangle without area.
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

/// Inserts in order; the farthest goes when there are too many, and then it is false.
[[nodiscard]] inline bool keep_nearest(const Contact& contact, ContactSet& contacts) noexcept
{
    TACTUS_ASSERT(!std::isnan(contact.distance_m)); // Else there is no order.
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

/// A direction of ContactEnds, not of unit length.
struct EndDirection
{
    std::array<double, 3> along{};
    double length{0.0};

    [[nodiscard]] double height_m(const Vec3& point_m) const noexcept
    {
        return along[0] * point_m[0] + (along[1] * point_m[1] + along[2] * point_m[2]);
    }
};

/// The first half: (0, 0, 0), which is none, would be in the middle of all.
inline constexpr auto kEndDirections = []
{
    // Of so many coordinates that are not 0.
    constexpr std::array kLengths{0.0, 1.0, std::numbers::sqrt2, std::numbers::sqrt3};
    std::array<EndDirection, kContactDirections / 2> directions{};
    int code = 0;
    for (EndDirection& direction : directions)
    {
        std::size_t axes = 0;
        int rest = code++;
        for (double& coordinate : direction.along)
        {
            coordinate = rest % 3 - 1;
            axes += rest % 3 != 1 ? 1U : 0U;
            rest /= 3;
        }
        direction.length = kLengths[axes];
    }
    return directions;
}();
[[nodiscard]] constexpr std::size_t opposite_end(std::size_t direction) noexcept
{
    return kContactDirections - 1 - direction;
}
inline constexpr double kEndPerDistance = 10.0;

/// Does not depend on the order of contacts: of equally far ones the first by comes_before() stays.
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
    for (std::size_t i = 0; i < kEndDirections.size(); ++i)
    {
        const EndDirection& direction = kEndDirections[i];
        const double height_m = direction.height_m(contact.on_surface_m) / direction.length;
        keep(i, height_m - less_m);
        keep(opposite_end(i), -height_m - less_m);
    }
    ends.is_empty = false;
}

/// Whether keep_ends() may keep a contact on this triangle that is at least so far from the core.
[[nodiscard]] inline bool may_be_end(const Triangle& triangle, double distance_m,
                                     const ContactEnds& ends) noexcept
{
    /// Many times what a contact's place and distance, and all of this, are rounded by.
    constexpr double kRounding = 1e-12;
    if (ends.is_empty)
    {
        return true;
    }
    double size_m = distance_m;
    for (const Vec3& corner : triangle)
    {
        size_m = std::max({size_m, std::abs(corner[0]), std::abs(corner[1]), std::abs(corner[2])});
    }
    const double less_m = kEndPerDistance * distance_m - kRounding * size_m;
    for (std::size_t i = 0; i < kEndDirections.size(); ++i)
    {
        const EndDirection& direction = kEndDirections[i];
        const double a = direction.height_m(triangle[0]);
        const double b = direction.height_m(triangle[1]);
        const double c = direction.height_m(triangle[2]);
        const double least_m = direction.length * (ends.reaches_m[i] + less_m);
        const double least_back_m = direction.length * (ends.reaches_m[opposite_end(i)] + less_m);
        if (std::max({a, b, c}) >= least_m || -std::min({a, b, c}) >= least_back_m)
        {
            return true;
        }
    }
    return false;
}

/// Adds a face to the slab that it differs least from, or makes one. Without a normal nothing is
/// proven: the slab is in all directions.
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
