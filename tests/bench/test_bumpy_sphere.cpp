// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/bumpy_sphere.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tactus::bench
{

namespace
{

constexpr double kPi = 3.14159265358979323846;

/// The formula of the page, by the C library's sine in long double.
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

/// The point of the surface in a direction, by bisection of the formula along the ray.
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

/// Up to 3 mm off the surface.
Vec3 random_place(test::Random& random)
{
    return surface_by_hand(random_direction(random)) + random.in_cube(1.7e-3);
}

/// The surface's nearest point by trying directions round the best so far, ever nearer to it.
Vec3 nearest_by_trial(const Vec3& x)
{
    Vec3 best = x.normalized();
    for (double spread = 0.1; spread > 1e-9; spread *= 0.5)
    {
        const Vec3 side = best.unitOrthogonal();
        const Vec3 other = best.cross(side);
        const Vec3 middle = best;
        for (int i = -4; i <= 4; ++i)
        {
            for (int j = -4; j <= 4; ++j)
            {
                const Vec3 tried = middle + 0.25 * spread * (i * side + j * other);
                if ((surface_by_hand(tried) - x).norm() < (surface_by_hand(best) - x).norm())
                {
                    best = tried;
                }
            }
        }
    }
    return surface_by_hand(best);
}

TEST(BumpySphere, value_and_gradient_are_those_of_the_formula)
{
    test::Random random(900);
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 x = random_place(random);
        ASSERT_NEAR(bumpy_value_m(x), value_by_hand(x), 1e-14);
        const Vec3 gradient = bumpy_gradient(x);
        for (int axis = 0; axis < 3; ++axis)
        {
            const Vec3 step = 1e-6 * Vec3::Unit(axis);
            const double slope = (value_by_hand(x + step) - value_by_hand(x - step)) / 2e-6;
            ASSERT_NEAR(gradient[axis], slope, 1e-7);
        }
    }
}

TEST(BumpySphere, the_foot_is_the_nearest_point_of_the_surface)
{
    test::Random random(901);
    for (int i = 0; i < 10; ++i)
    {
        const Vec3 x = random_place(random);
        const SurfaceFoot foot = bumpy_foot(x);
        const Vec3 truth = nearest_by_trial(x);
        EXPECT_NEAR(value_by_hand(foot.point_m), 0.0, 1e-15);
        EXPECT_NEAR(std::abs(foot.distance_m), (truth - x).norm(), 1e-12);
        EXPECT_LT((foot.point_m - truth).norm(), 1e-8);
        EXPECT_EQ(foot.distance_m > 0.0, value_by_hand(x) > 0.0);
        EXPECT_LT((foot.point_m + foot.distance_m * foot.normal - x).norm(), 1e-15);
    }
}

TEST(BumpySphere, no_section_through_a_normal_turns_faster_than_the_curvature_and_one_does)
{
    test::Random random(902);
    for (int i = 0; i < 30; ++i)
    {
        const SurfaceFoot foot = bumpy_foot(random_place(random));
        const Vec3 side = foot.normal.unitOrthogonal();
        const Vec3 other = foot.normal.cross(side);
        double fastest = 0.0;
        for (int step = 0; step < 720; ++step)
        {
            const double angle = 2.0 * kPi * step / 720;
            const Vec3 along = std::cos(angle) * side + std::sin(angle) * other;
            const Vec3 there = surface_by_hand(foot.point_m + 1e-5 * along);
            // How far a parabola through here lies below the tangent plane there.
            const double below = -(there - foot.point_m).dot(foot.normal);
            fastest = std::max(fastest, std::abs(2.0 * below / 1e-10));
        }
        EXPECT_NEAR(bumpy_curvature_per_m(foot.point_m), fastest, 0.1 + 0.01 * fastest);
        EXPECT_LT(fastest, 1.0 / 0.02);
    }
}

TEST(BumpySphere, the_force_is_the_spring_s_over_the_depth_below_the_offset)
{
    test::Random random(903);
    for (int i = 0; i < 50; ++i)
    {
        const SurfaceFoot foot = bumpy_foot(surface_by_hand(random_direction(random)));
        const Vec3 device = foot.point_m + (2e-3 - 0.75e-3) * foot.normal;
        EXPECT_LT((bumpy_force_n(device, 2e-3, 1'000.0) - 0.75 * foot.normal).norm(), 1e-9);
        EXPECT_EQ(bumpy_force_n(device, 1e-3, 1'000.0).norm(), 0.0);
    }
}

TEST(BumpySphere, a_sweep_keeps_its_pace_and_its_depth)
{
    const Touch touch{0.5e-3, 1e-3, 1'000.0};
    const Sweep sweep = make_sweep(touch, 0.3e-3, 2'000);

    ASSERT_EQ(sweep.goals_m.size(), sweep.lead_in + 2'000);
    ASSERT_EQ(sweep.rests_m.size(), sweep.goals_m.size());
    EXPECT_GT(bumpy_foot(sweep.goals_m.front()).distance_m, 1.2e-3);
    for (std::size_t i = sweep.lead_in; i < sweep.goals_m.size(); ++i)
    {
        const Vec3& goal = sweep.goals_m[i];
        ASSERT_LE((goal - sweep.goals_m[i - 1]).norm(), 0.3e-3 * (1.0 + 1e-9));
        ASSERT_NEAR(bumpy_foot(goal).distance_m, -0.5e-3, 1e-15);
        const Vec3 spring_n = 1'000.0 * (sweep.rests_m[i] - goal);
        ASSERT_LT((bumpy_force_n(goal, 0.5e-3, 1'000.0) - spring_n).norm(), 1e-9);
    }
    const Vec3 way = sweep.goals_m[sweep.lead_in + 1'000] - sweep.goals_m[sweep.lead_in + 999];
    EXPECT_NEAR(way.norm(), 0.3e-3, 1e-12);
}

std::vector<test::Face> faces_of(const TriangleMesh& mesh)
{
    std::vector<test::Face> faces;
    for (const auto& corners : mesh.faces)
    {
        test::Face& face = faces.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
        {
            std::ranges::transform(mesh.positions[corners[i]], face[i].begin(),
                                   [](double x) { return static_cast<float>(x); });
        }
    }
    return faces;
}

Vec3 at(const test::Face& face, double s, double t)
{
    return (1.0 - s - t) * to_vec3(face[0]) + s * to_vec3(face[1]) + t * to_vec3(face[2]);
}

TEST(Faceting, covers_all_points_of_the_faces)
{
    const std::vector<test::Face> faces = faces_of(make_shape(Shape::bumpy_sphere, 1'280).value());
    const Faceting sut = measure_faceting(faces, {});
    test::Random random(904);
    double farthest_m = 0.0;
    for (int i = 0; i < 3'000; ++i)
    {
        const test::Face& face = faces[random.below(faces.size())];
        const double s = random.between(0.0, 1.0);
        const Vec3 point = at(face, s, random.between(0.0, 1.0 - s));
        const SurfaceFoot foot = bumpy_foot(point);
        farthest_m = std::max(farthest_m, std::abs(foot.distance_m));
        const Vec3 normal = (to_vec3(face[1]) - to_vec3(face[0]))
                                .cross(to_vec3(face[2]) - to_vec3(face[0]))
                                .normalized();
        ASSERT_LE(std::acos(std::min(1.0, normal.dot(foot.normal))), 1.02 * sut.normal_rad);
    }
    EXPECT_LE(farthest_m, 1.02 * sut.distance_m);
    EXPECT_GE(farthest_m, 0.7 * sut.distance_m);
    EXPECT_GT(sut.normal_rad, 0.02);
    EXPECT_GT(sut.dihedral_rad, sut.normal_rad);
}

TEST(Faceting, an_origin_moves_the_mesh)
{
    std::vector<test::Face> faces = faces_of(make_shape(Shape::bumpy_sphere, 320).value());
    const Faceting here = measure_faceting(faces, {});
    for (test::Face& face : faces)
    {
        for (Vec3f& corner : face)
        {
            corner[1] += 0.0625F;
        }
    }
    const Faceting there = measure_faceting(faces, {0.0, -0.0625, 0.0});

    EXPECT_NEAR(there.distance_m, here.distance_m, 1e-7);
    EXPECT_NEAR(there.normal_rad, here.normal_rad, 1e-5);
}

TEST(Faceting, the_dihedral_is_the_sharpest_fold)
{
    const auto fold = [](double angle)
    {
        const test::Face left{{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}};
        const test::Face right{
            {{0, 1, 0},
             {0, 0, 0},
             {static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))}}};
        return std::vector{left, right};
    };
    EXPECT_NEAR(largest_dihedral_rad(fold(0.3)), 0.3, 1e-6);
    EXPECT_NEAR(largest_dihedral_rad(fold(-2.0)), 2.0, 1e-6);
    EXPECT_EQ(largest_dihedral_rad({fold(0.3)[0]}), 0.0);
}

/// Where a ball rests whose device pulls it to a goal, by trying directions: on each the place
/// where the mesh first leaves room, of which the nearest counts.
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

/// The bounds hold for a ball that rests where the mesh lets it, and are not far too large.
TEST(Faceting, bounds_the_force_of_a_ball_that_rests_on_the_mesh)
{
    const std::vector<test::Face> faces = faces_of(make_shape(Shape::bumpy_sphere, 5'120).value());
    const test::FaceTree tree(faces);
    const Faceting sut = measure_faceting(faces, {});
    test::Random random(905);
    // The device stays outside the mesh, where its distance alone tells where there is room.
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
    EXPECT_LE(worst_rad, sut.force_turn_rad(touch));
    EXPECT_GE(worst_rad, 0.3 * sut.force_turn_rad(touch));
}

TEST(Faceting, the_force_s_error_is_of_its_length_and_of_its_direction)
{
    const Faceting sut{1e-5, 0.1, 0.0, 50.0};
    const Touch touch{3e-3, 2e-3, 1'000.0};

    EXPECT_NEAR(sut.force_turn_rad(touch), 0.1 / 0.75, 1e-12);
    EXPECT_NEAR(sut.force_error_n(touch), 0.01 + 2.0 * 0.1 / 0.75, 1e-12);
}

} // namespace

} // namespace tactus::bench
