// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/force_rows.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tactus::bench
{

namespace
{

/// Formula of the page, with the C library's sine in long double.
double value_by_hand(const Vec3& x)
{
    const long double length = std::sqrt(static_cast<long double>(x.squaredNorm()));
    long double bumps = 1.0L;
    for (const double coordinate : {x.x(), x.y(), x.z()})
    {
        bumps *= std::sin(8.0L * static_cast<long double>(coordinate) / length);
    }
    return static_cast<double>(length - 0.05L * (1.0L + 0.02L * bumps));
}

/// Point of the surface in a direction, by bisection of the formula along the ray.
Vec3 surface_by_hand(const Vec3& direction)
{
    const Vec3 unit = direction.normalized();
    double low_m = 0.04;
    double high_m = 0.06;
    while (0.5 * (low_m + high_m) > low_m && 0.5 * (low_m + high_m) < high_m)
    {
        const double middle_m = 0.5 * (low_m + high_m);
        (value_by_hand(middle_m * unit) < 0.0 ? low_m : high_m) = middle_m;
    }
    return low_m * unit;
}

Vec3 random_direction(test::Random& random)
{
    Vec3 direction = random.in_cube(1.0);
    while (direction.norm() < 0.1 || direction.norm() > 1.0)
    {
        direction = random.in_cube(1.0);
    }
    return direction.normalized();
}

/// Rest position of a sphere that a device pulls to a goal, by trial: the nearest of the places at
/// which each direction leaves the mesh.
Vec3 rest_by_trial(const test::FaceTree& tree, const Vec3& goal, const Vec3& normal,
                   double radius_m)
{
    const auto place = [&](const Vec3& direction) -> Vec3
    {
        const Vec3 unit = direction.normalized();
        double low_m = 0.0;
        double high_m = 4e-3;
        for (int i = 0; i < 40; ++i)
        {
            const double middle_m = 0.5 * (low_m + high_m);
            const bool has_room = tree.nearest(goal + middle_m * unit).distance_m >= radius_m;
            (has_room ? high_m : low_m) = middle_m;
        }
        return goal + high_m * unit;
    };
    Vec3 best = normal;
    double best_m = (place(best) - goal).norm();
    for (double spread = 0.3; spread > 1e-5; spread *= 0.6)
    {
        const Vec3 middle = best.normalized();
        const Vec3 side = middle.unitOrthogonal();
        const Vec3 other = middle.cross(side);
        for (int i = -3; i <= 3; ++i)
        {
            for (int j = -3; j <= 3; ++j)
            {
                const Vec3 tried = middle + spread / 3.0 * (i * side + j * other);
                const double way_m = (place(tried) - goal).norm();
                best = way_m < best_m ? tried : best;
                best_m = std::min(way_m, best_m);
            }
        }
    }
    return place(best);
}

/// The bounds hold for a sphere that rests on the mesh, and are not far too large.
TEST(Faceting, bounds_the_force_of_a_sphere_that_rests_on_the_mesh)
{
    const std::vector<test::Face> faces = faces_of(make_shape(Shape::bumpy_sphere, 5'120).value());
    const test::FaceTree tree(faces);
    const Faceting sut = measure_faceting(faces, {});
    test::Random random(905);
    // The device stays outside the mesh, where its distance alone determines the free space.
    const Touch touch{2e-3, 1.8e-3, 1'000.0};
    double farthest_m = 0.0;
    double worst_rad = 0.0;
    for (int i = 0; i < 60; ++i)
    {
        const SurfaceFoot foot = bumpy_foot(surface_by_hand(random_direction(random)));
        const Vec3 goal = foot.point_m + (touch.radius_m - touch.depth_m) * foot.normal;
        const Vec3 spring = rest_by_trial(tree, goal, foot.normal, touch.radius_m) - goal;
        farthest_m = std::max(farthest_m, std::abs(spring.norm() - touch.depth_m));
        worst_rad = std::max(worst_rad, std::acos(spring.normalized().dot(foot.normal)));
        const Vec3 error_n = touch.stiffness_n_per_m * spring -
                             bumpy_force_n(goal, touch.radius_m, touch.stiffness_n_per_m);
        EXPECT_LE(error_n.norm(), sut.force_error_n(touch));
    }
    EXPECT_LE(farthest_m, sut.distance_m);
    EXPECT_GE(farthest_m, 0.3 * sut.distance_m);
    EXPECT_LE(worst_rad, sut.force_rotation_rad(touch));
    EXPECT_GE(worst_rad, 0.3 * sut.force_rotation_rad(touch));
}

} // namespace

} // namespace tactus::bench
