// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/placed_core.hpp"
#include "tests/shared/shape_scenes.hpp"
#include "tests/unit/geometry/hull_oracle.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus::test
{
namespace
{

using Oracle = ShapeOracle<long double>;

Mat3 random_rotation(Random& random)
{
    const Vec3 axis = random.in_cube(1.0) + Vec3(1e-3, 0, 0);
    return Eigen::AngleAxisd(random.between(-4.0, 4.0), axis.normalized()).toRotationMatrix();
}

Similarity random_place(Random& random)
{
    return {random_rotation(random), random.in_cube(2.0), random.between(0.2, 3.0)};
}

/// Core with its vertices, if any.
struct OwnedCore
{
    std::vector<Vec3> vertices;
    ToolCore core{};
};

/// Hull of up to seven vertices, including flat and duplicate ones.
void make_hull(OwnedCore& owned, double size, Random& random)
{
    const std::uint32_t count = 1 + random.below(7);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        Vec3 vertex = random.in_cube(size);
        vertex.z() *= random.one_in(3) ? 0.0 : 1.0;
        owned.vertices.push_back(i > 0 && random.one_in(6) ? owned.vertices[0] : vertex);
    }
    owned.core = Hull::create(owned.vertices).value();
}

/// Solid core, including flat ones and single points.
ToolCore random_solid(double size, Random& random)
{
    switch (random.below(3))
    {
    case 0:
        return PointCore{};
    case 1:
        return Segment{random.in_cube(size), random.in_cube(size)};
    default:
        return Box{{size, random.one_in(3) ? 0.0 : size * random.between(0.01, 1.0),
                    size * random.between(0.0, 1.0)}};
    }
}

OwnedCore random_core(Random& random)
{
    const double size = random.one_in(8) ? 0.0 : random.between(0.01, 1.0);
    OwnedCore owned;
    if (random.one_in(4))
    {
        make_hull(owned, size, random);
        return owned;
    }
    owned.core = random_solid(size, random);
    return owned;
}

/// Points of the core in its own frame, including its corners.
std::vector<Vec3> points_of(const ToolCore& core, Random& random)
{
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i)
    {
        const auto share = [&]
        { return i < 8 ? 2.0 * random.below(2) - 1.0 : random.between(-1, 1); };
        const Vec3 shares{share(), share(), share()};
        if (const auto* segment = std::get_if<Segment>(&core))
        {
            points.push_back(point_at(*segment, 0.5 + 0.5 * shares.x()));
        }
        else if (const auto* box = std::get_if<Box>(&core))
        {
            points.push_back(box->half.cwiseProduct(shares));
        }
        else if (const auto* hull = std::get_if<Hull>(&core))
        {
            const auto vertices = hull->vertices();
            const auto any = [&]
            { return vertices[random.below(static_cast<std::uint32_t>(vertices.size()))]; };
            const Vec3 first = 0.5 * (1.0 + shares.x()) * any();
            points.push_back(first + 0.5 * (1.0 - shares.x()) * any());
        }
        else
        {
            points.emplace_back(0.0, 0.0, 0.0);
        }
    }
    return points;
}

Vec3 placed(const Similarity& place, const Vec3& point)
{
    return place.translation_m + place.scale * (place.rotation * point);
}

/// Distance by the oracle, of a core placed by separate arithmetic.
long double true_distance(const ToolCore& core, const Similarity& place, const Triangle& triangle)
{
    if (const auto* segment = std::get_if<Segment>(&core))
    {
        const std::array<Vec3, 2> ends{placed(place, segment->from), placed(place, segment->to)};
        return Oracle::distance(ends, triangle);
    }
    if (const auto* box = std::get_if<Box>(&core))
    {
        Triangle near;
        for (std::size_t i = 0; i < 3; ++i)
        {
            near[i] =
                place.rotation.transpose() * (triangle[i] - place.translation_m) / place.scale;
        }
        return Oracle::distance(*box, near) * static_cast<long double>(place.scale);
    }
    if (const auto* hull = std::get_if<Hull>(&core))
    {
        std::vector<Vec3> vertices;
        for (const Vec3& vertex : hull->vertices())
        {
            vertices.push_back(placed(place, vertex));
        }
        return HullOracle<long double>::distance(vertices, triangle);
    }
    return Oracle::Base::distance(place.translation_m, triangle);
}

Triangle random_triangle(Random& random)
{
    const Vec3 at = random.in_cube(3.0);
    const double size = random.one_in(4) ? 1e-3 : 1.0;
    return {at + random.in_cube(size), at + random.in_cube(size), at + random.in_cube(size)};
}

} // namespace

TEST(PlacedCore, measures_as_the_oracle_does_and_bounds_from_below)
{
    Random random(301);
    int touching = 0;
    double loosest = 0.0;
    for (int round = 0; round < 20'000; ++round)
    {
        const OwnedCore owned = random_core(random);
        const ToolCore& core = owned.core;
        const Similarity place = random_place(random);
        const PlacedCore sut(core, place);
        const Triangle triangle = random_triangle(random);
        const auto truth = static_cast<double>(true_distance(core, place, triangle));

        const ClosestPoints closest = sut.closest(triangle);
        const CoreBounds bounds = sut.bounds(triangle);

        // The oracle of a box rotates the triangle in double, accurate to 1e-15 of its place.
        const double slack = closest.distance_error + 4e-14;
        ASSERT_NEAR(closest.distance, truth, slack)
            << "round " << round << ", core " << core.index();
        ASSERT_LE(bounds.lower, truth + 2e-14) << "round " << round;
        ASSERT_GE(bounds.upper, truth - 2e-14) << "round " << round;
        ASSERT_TRUE(closest.meet || !bounds.meet) << "round " << round;
        ASSERT_GE(closest.distance + slack, (triangle[0] - sut.center()).norm() - sut.radius() -
                                                (triangle[1] - triangle[0]).norm() -
                                                (triangle[2] - triangle[0]).norm())
            << "round " << round;
        ASSERT_NEAR((closest.on_triangle - closest.on_shape).norm(), closest.distance,
                    closest.distance_error + 1e-13)
            << "round " << round;
        touching += closest.meet ? 1 : 0;
        loosest = std::max(loosest, truth - bounds.lower);
    }
    EXPECT_GT(touching, 100);
    EXPECT_LT(loosest, 5.0) << "a bound that bounds nothing";
}

TEST(PlacedCore, bounds_triangles_that_share_corners_and_proves_planes_between)
{
    Random random(304);
    int met = 0;
    int separated = 0;
    for (int round = 0; round < 5'000; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        const OwnedCore owned = random_core(random);
        const Similarity place = random_place(random);
        const PlacedCore sut(owned.core, place);
        const Vec3 at = random.in_cube(2.0);
        const double size = random.one_in(4) ? 1e-2 : 1.0;
        std::array<std::array<float, CornersAtCore::kCorners>, 3> corners{};
        for (std::size_t i = 0; i < CornersAtCore::kCorners; ++i)
        {
            const Vec3 corner = at + random.in_cube(size);
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                corners[axis][i] = static_cast<float>(corner[static_cast<Eigen::Index>(axis)]);
            }
        }
        CornersAtCore seen;
        sut.measure_corners(corners, seen);
        for (std::uint8_t i = 0; i + 2U < CornersAtCore::kCorners; i += 3)
        {
            Triangle triangle;
            for (std::size_t k = 0; k < 3; ++k)
            {
                triangle[k] =
                    to_vec3(Vec3f{corners[0][i + k], corners[1][i + k], corners[2][i + k]});
            }
            const ClosestPoints closest = sut.closest(triangle);
            const double limit = random.between(0.0, 1.0);
            const CoreBounds bounds = sut.bounds(
                seen, {i, static_cast<std::uint8_t>(i + 1), static_cast<std::uint8_t>(i + 2)},
                limit);
            const CoreSeparation plane = sut.separation(triangle);

            const double slack = closest.distance_error + 1e-14;
            ASSERT_LE(bounds.lower, closest.distance + slack);
            ASSERT_GE(bounds.upper, closest.distance - slack);
            ASSERT_TRUE(!bounds.meet || closest.distance <= slack);
            if (bounds.lower <= limit && !sut.is_convex_body())
            {
                // The result equals both together.
                const CoreBounds own = sut.bounds(triangle);
                ASSERT_NEAR(bounds.lower, own.lower, 1e-13);
                ASSERT_NEAR(bounds.upper, own.upper, 1e-13);
            }
            ASSERT_LE(plane.distance, closest.distance + slack);
            if (plane.distance > 0.0)
            {
                ++separated;
                double highest = -std::numeric_limits<double>::infinity();
                for (const Vec3& corner : triangle)
                {
                    highest = std::max(highest, plane.normal.dot(corner));
                }
                for (const Vec3& point : points_of(owned.core, random))
                {
                    ASSERT_GE(plane.normal.dot(placed(place, point)) - highest,
                              plane.distance - 1e-13);
                }
            }
            met += bounds.meet ? 1 : 0;
        }
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(separated, 1'000);
}

TEST(PlacedCore, is_held_by_its_sphere_and_by_its_cover)
{
    Random random(302);
    std::size_t most = 0;
    for (int round = 0; round < 3'000; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        const OwnedCore owned = random_core(random);
        const ToolCore& core = owned.core;
        const Similarity place = random_place(random);
        const PlacedCore sut(core, place);
        const double enough = sut.radius() * random.between(0.0, 1.2);

        const CoreCover cover = sut.cover(enough);

        most = std::max(most, cover.size());
        ASSERT_LE(cover.size(), kMaxCoverSpheres);
        for (const Vec3& point : points_of(core, random))
        {
            const Vec3 there = placed(place, point);
            ASSERT_LE((there - sut.center()).norm(), sut.radius() * (1.0 + 1e-12) + 1e-14);
            double nearest = std::numeric_limits<double>::infinity();
            for (const Sphere& sphere : cover)
            {
                nearest = std::min(nearest, (there - sphere.center).norm() - sphere.radius);
                ASSERT_TRUE(sphere.radius <= enough || cover.size() == kMaxCoverSpheres);
            }
            ASSERT_LE(nearest, 1e-14);
        }
    }
    EXPECT_EQ(most, kMaxCoverSpheres);
}

TEST(PlacedCore, a_point_is_covered_by_one_sphere_of_no_size)
{
    const PlacedCore sut(PointCore{}, {Mat3::Identity(), Vec3(1, 2, 3), 0.5});
    const CoreCover cover = sut.cover(0.0);
    ASSERT_EQ(cover.size(), 1U);
    EXPECT_EQ(cover[0].center, Vec3(1, 2, 3));
    EXPECT_EQ(cover[0].radius, 0.0);
    EXPECT_TRUE(sut.is_point());
}

TEST(PlacedCore, no_point_moved_farther_than_it_says)
{
    Random random(303);
    for (int round = 0; round < 3'000; ++round)
    {
        const OwnedCore owned = random_core(random);
        const ToolCore& core = owned.core;
        const Similarity before = random_place(random);
        Similarity after = before;
        const double much = random.one_in(3) ? 1.0 : 1e-6;
        after.translation_m += random.in_cube(much);
        after.rotation =
            Eigen::AngleAxisd{much * random.between(-1, 1), random.in_cube(1.0).normalized()}
                .toRotationMatrix() *
            before.rotation;
        after.scale *= 1.0 + much * random.between(-0.5, 0.5);

        const double motion = PlacedCore(core, after).motion_since(PlacedCore(core, before));

        double farthest = 0.0;
        for (const Vec3& point : points_of(core, random))
        {
            const double way = (placed(after, point) - placed(before, point)).norm();
            ASSERT_LE(way, motion + 1e-14);
            farthest = std::max(farthest, way);
        }
        ASSERT_LE(motion, 8.0 * farthest + 1e-9) << "far too much";
    }
}

} // namespace tactus::test
