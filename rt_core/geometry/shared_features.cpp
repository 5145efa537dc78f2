// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/shared_features.hpp"

#include "rt_core/geometry/boundary_distance.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/face_filter.hpp"
#include "rt_core/math/kernel_error.hpp"

#include <array>
#include <bit>
#include <span>

namespace tactus
{

namespace
{

/// Distance of the nearest points, in local lengths, below which the vector between them has too
/// few correct bits for a test of sides.
constexpr double kLeastApart = 1e-6;

/// Squared sine of the angle between two edges below which many points are nearly the nearest.
constexpr double kLeastSineSq = 1e-6;

/// Corners of each feature of a triangle, one bit each.
constexpr std::array<std::uint32_t, 7> kCornersOf{1, 2, 4, 3, 6, 5, 7};

TriangleFeature feature_of(std::uint32_t corners) noexcept
{
    std::size_t feature = 0;
    while (kCornersOf[feature] != corners)
    {
        ++feature;
    }
    return static_cast<TriangleFeature>(feature);
}

bool is_same(const Vec3& a, const Vec3& b) noexcept
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// Finds which corners of the triangle these are, as bits; 0 unless each equals exactly one of the
/// triangle's.
std::uint32_t find_corners(const Triangle& triangle, std::span<const Vec3> corners) noexcept
{
    std::uint32_t found = 0;
    for (const Vec3& corner : corners)
    {
        std::uint32_t here = 0;
        for (std::uint32_t i = 0; i < 3; ++i)
        {
            here |= is_same(triangle[i], corner) ? 1U << i : 0U;
        }
        if (!std::has_single_bit(here))
        {
            return 0;
        }
        found |= here;
    }
    return found;
}

/// True if the triangle's other corners are farther along `way` than those in `corners`, by more
/// than `margin`.
bool are_others_beyond(const Triangle& triangle, std::uint32_t corners, const Vec3& way,
                       double margin) noexcept
{
    const Vec3& from = triangle[static_cast<std::size_t>(std::countr_zero(corners))];
    for (std::uint32_t left = 7U & ~corners; left != 0; left &= left - 1)
    {
        const Vec3& other = triangle[static_cast<std::size_t>(std::countr_zero(left))];
        if (!((other - from).dot(way) > margin))
        {
            return false;
        }
    }
    return true;
}

StaticVector<Vec3, 3> corners_of(const Triangle& triangle, TriangleFeature feature) noexcept
{
    StaticVector<Vec3, 3> corners;
    for (std::uint32_t left = kCornersOf[static_cast<std::size_t>(feature)]; left != 0;
         left &= left - 1)
    {
        corners.push_back(triangle[static_cast<std::size_t>(std::countr_zero(left))]);
    }
    return corners;
}

/// True if two features have a single pair of nearest points.
bool has_one_nearest(std::span<const Vec3> first, std::span<const Vec3> second) noexcept
{
    if (first.size() == 1 || second.size() == 1)
    {
        return true;
    }
    if (first.size() != 2 || second.size() != 2)
    {
        return false;
    }
    const Vec3 u = first[1] - first[0];
    const Vec3 v = second[1] - second[0];
    return u.cross(v).squaredNorm() > kLeastSineSq * (u.squaredNorm() * v.squaredNorm());
}

/// True if one of the triangle's corners has this coordinate.
bool has_key(const Triangle& triangle, double key) noexcept
{
    return (static_cast<unsigned>(triangle[0][0] == key) |
            static_cast<unsigned>(triangle[1][0] == key) |
            static_cast<unsigned>(triangle[2][0] == key)) != 0;
}

} // namespace

ClosestPoints SharedFeatures::closest_points(const Triangle& first, const Triangle& second) noexcept
{
    if (const auto found = find(first, second))
    {
        return *found;
    }
    const ClosestPoints closest = tactus::closest_points(first, second, false);
    const Known known{corners_of(first, closest.shape_feature), corners_of(second, closest.feature),
                      closest};
    if (has_one_nearest(known.first.view(), known.second.view()))
    {
        keep(known);
    }
    return closest;
}

/// Finds a known pair of features that both triangles have. The connection of the features is
/// perpendicular to both, so each lies in one plane across it; `margin` covers the plane's
/// rounding.
std::optional<ClosestPoints> SharedFeatures::find(const Triangle& first,
                                                  const Triangle& second) const noexcept
{
    for (std::size_t i = 0; i < known_.size(); ++i)
    {
        if (!has_key(first, first_keys_[i]) || !has_key(second, second_keys_[i]))
        {
            continue;
        }
        const Known& known = known_[i];
        const std::uint32_t of_first = find_corners(first, known.first.view());
        const std::uint32_t of_second = find_corners(second, known.second.view());
        if (of_first == 0 || of_second == 0)
        {
            continue;
        }
        const double length = local_length(first, second);
        const Vec3& way = known.closest.gap;
        const double margin = kFilterMargin * length * known.closest.distance;
        const std::array points{first[0], first[1], first[2], second[0], second[1], second[2]};
        if (known.closest.distance > kLeastApart * length &&
            are_others_beyond(first, of_first, -way, margin) &&
            are_others_beyond(second, of_second, way, margin) &&
            safe_scale(largest_coordinate(points)) == 1.0)
        {
            ClosestPoints closest = known.closest;
            closest.shape_feature = feature_of(of_first);
            closest.feature = feature_of(of_second);
            closest.distance_error = kernel_error(0.0, length);
            return closest;
        }
    }
    return std::nullopt;
}

void SharedFeatures::keep(const Known& known) noexcept
{
    std::size_t place = known_.size();
    if (!known_.try_push_back(known))
    {
        place = oldest_;
        oldest_ = (oldest_ + 1) % kKnown;
        known_[place] = known;
    }
    first_keys_[place] = known.first[0][0];
    second_keys_[place] = known.second[0][0];
}

} // namespace tactus
