// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Force shading equals the gradient of its energy, generates none, and removes steps. The oracle
/// is that energy, implemented again with other distances, and differentiated numerically.

#include "rt_core/force/force_shading.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/closest_point.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/rt_core/proxy_rig.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr double kSphere = 0.002;
constexpr double kWidth = 0.006;

Point<double> plain(const Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Sphere of 8 n^2 faces.
TriangleList sphere(double radius_m, int n)
{
    TriangleList list;
    const auto at = [&](int octant, int i, int j)
    {
        Vec3 place(i, j, n - i - j);
        for (int axis = 0; axis < 3; ++axis)
        {
            place[axis] *= (octant >> axis & 1) != 0 ? -1.0 : 1.0;
        }
        return to_float(radius_m * place.normalized());
    };
    for (int octant = 0; octant < 8; ++octant)
    {
        for (int i = 0; i < n; ++i)
        {
            for (int j = 0; i + j < n; ++j)
            {
                list.push_back({at(octant, i, j), at(octant, i + 1, j), at(octant, i, j + 1)});
                if (i + j + 1 < n)
                {
                    list.push_back(
                        {at(octant, i + 1, j), at(octant, i + 1, j + 1), at(octant, i, j + 1)});
                }
            }
        }
    }
    return list;
}

/// Field of hills `high_m` high in 12 x 12 cells of 4 mm around the origin.
TriangleList hills(double high_m, Random& random)
{
    constexpr std::size_t kCells = 12;
    constexpr double kCell_m = 0.004;
    std::array<std::array<Vec3, kCells + 1>, kCells + 1> at;
    for (std::size_t i = 0; i <= kCells; ++i)
    {
        for (std::size_t j = 0; j <= kCells; ++j)
        {
            at[i][j] =
                Vec3{kCell_m * (static_cast<double>(i) - 0.5 * kCells + random.between(-0.2, 0.2)),
                     kCell_m * (static_cast<double>(j) - 0.5 * kCells + random.between(-0.2, 0.2)),
                     random.between(-high_m, high_m)};
        }
    }
    TriangleList list;
    for (std::size_t i = 0; i < kCells; ++i)
    {
        for (std::size_t j = 0; j < kCells; ++j)
        {
            add_square(list, at[i][j], at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]);
        }
    }
    return list;
}

/// h(p) if all faces have the same orientation.
double rise_at(const TriangleList& list, const Vec3& place, double radius_m, double width_m)
{
    double weights = 0.02;
    double sum = 0.0;
    for (const auto& corners : list)
    {
        const Vec3 a = to_vec3(corners[0]);
        const Vec3 across = (to_vec3(corners[1]) - a).cross(to_vec3(corners[2]) - a);
        const Point<double> nearest = closest_on_triangle(
            plain(place), plain(a), plain(to_vec3(corners[1])), plain(to_vec3(corners[2])));
        const double distance = (place - Vec3(nearest[0], nearest[1], nearest[2])).norm();
        const double lateral_sq = distance * distance - radius_m * radius_m;
        const double rise = radius_m - std::abs(across.normalized().dot(place - a));
        if (lateral_sq < width_m * width_m && std::abs(rise) < width_m / 8.0)
        {
            const double weight = std::min(1.0, 0.5 * across.norm() / (width_m * width_m)) *
                                  std::pow(1.0 - lateral_sq / (width_m * width_m), 2) *
                                  std::pow(1.0 - std::pow(8.0 * rise / width_m, 6), 2);
            weights += weight;
            sum += weight * rise;
        }
    }
    return sum / weights;
}

ToolSpec smooth_sphere(double width_m)
{
    ToolSpec spec = sphere_tool();
    spec.radius_m = kSphere;
    spec.shading_m = width_m;
    return spec;
}

/// Changes of the force over a sphere of about 5,000 faces, 0.1 mm a frame.
struct Ride
{
    double largest_step_n{0.0};
    double worst_angle{0.0}; ///< Angle to the sphere's normal.
    double least_gap_m{kInfinity};
};
Ride ride(const TriangleList& list, double radius_m, double depth_m, double width_m)
{
    constexpr double kWay_m = 1e-4;
    const double out_m = radius_m + kSphere - depth_m;
    const Vec3 u = Vec3(0.3, 0.5, 0.8).normalized();
    const Vec3 v = u.cross(Vec3(0.9, -0.3, 0.1)).normalized();
    const auto hand_on = [&](int step)
    {
        const double angle = step * kWay_m / out_m;
        return Vec3(out_m * (std::cos(angle) * u + std::sin(angle) * v));
    };
    constexpr int kSteps = 250;
    TriangleList near; // Triangles in reach of the path; the rest would only take time.
    for (const auto& corners : list)
    {
        const Vec3 middle = hand_on(kSteps / 2);
        if ((to_vec3(corners[0]) - middle).norm() < 0.5 * kSteps * kWay_m + 0.018)
        {
            near.push_back(corners);
        }
    }
    ProxyRig rig(near, (radius_m + 3.0 * kSphere) * u, {}, smooth_sphere(width_m));
    rig.certified = 0.012;
    (void)rig.settle(hand_on(0), 20);
    Ride result;
    Vec3 last = rig.step(hand_on(0)).force_n;
    for (int step = 1; step < kSteps; ++step)
    {
        const ToolOutput output = rig.step(hand_on(step));
        const Vec3 normal = hand_on(step).normalized();
        result.largest_step_n = std::max(result.largest_step_n, (output.force_n - last).norm());
        result.worst_angle = std::max(result.worst_angle,
                                      output.force_n.cross(normal).norm() / output.force_n.norm());
        result.least_gap_m = std::min(result.least_gap_m, rig.clearance() - kSphere);
        EXPECT_GT(output.force_n.dot(normal), 0.0);
        last = output.force_n;
    }
    return result;
}

/// Work on a hand in two rounds of a closed path, in and out of the hills.
double work_over(const TriangleList& list, double width_m, double friction, std::uint64_t seed)
{
    Random random = Random::seeded(seed);
    const Vec3 wide_m{random.between(2e-3, 5e-3), random.between(2e-3, 5e-3), 0.0};
    const double dip_m = random.between(2e-4, 5e-4);
    const double phase = random.between(0.0, 6.0);
    TriangleList near;
    std::ranges::copy_if(list, std::back_inserter(near),
                         [](const auto& corners) { return to_vec3(corners[0]).norm() < 0.017; });
    ProxyRig rig(near, Vec3(0, 0, 0.01), {}, smooth_sphere(width_m));
    rig.certified = 0.01;
    rig.material().static_friction = rig.material().dynamic_friction = friction;
    const auto hand_of = [&](int step)
    {
        const double angle = 2.0 * std::numbers::pi * step / 2'000.0;
        return hand_at(Vec3(wide_m.x() * std::cos(angle), wide_m.y() * std::sin(angle),
                            kSphere - 1e-3 + dip_m * std::sin(angle + phase)));
    };
    (void)rig.settle(hand_of(0).position_m, 200);
    return work_of_rounds(rig, hand_of, 2'000);
}

} // namespace

TEST(ForceShading, are_the_derivative_of_their_energy_and_keep_within_their_bounds)
{
    Random random = Random::seeded(seed_of(3201));
    double steepest = 0.0;
    int cut_off = 0;
    for (int i = 0; i < 300; ++i)
    {
        SCOPED_TRACE(i);
        const TriangleList list = hills(random.between(0.0, 2e-4), random);
        const Vec3 center{random.between(-0.01, 0.01), random.between(-0.01, 0.01), 0.0};
        const double z = kSphere + random.between(-1e-4, 2e-4);
        const Vec3 place = center + Vec3(0, 0, z);
        const Vec3 normal(0, 0, 1);
        const double depth_m = random.between(1e-6, 0.005);
        const auto surface = surface_of(list, place, 0.02);
        const ObjectPose pose;
        const Material material;
        ProxyMemory memory;
        const PlacedSurface placed = placed_surface(pose, surface.get(), material, memory);
        const ForceShading sut(kWidth, {&placed, 1}, kInfinity);
        const auto felt = sut.at({place, normal, kSphere, 0.0}, depth_m);

        const double limit_m = kWidth / 16.0;
        const double raised_m = depth_m * depth_m / (depth_m + limit_m);
        const double rise_m = rise_at(list, place, kSphere, kWidth);
        EXPECT_NEAR(felt.raised_m, raised_m, 1e-15);
        EXPECT_NEAR(felt.raise_m.dot(normal), raised_m, 1e-12);
        EXPECT_LT(std::abs(rise_m), kWidth / 8.0);
        const auto energy = [&](double d) { return d * d / (d + limit_m) * rise_m; };
        const double step_m = 1e-3 * depth_m;
        const double slope_m =
            (energy(depth_m + step_m) - energy(depth_m - step_m)) / (2.0 * step_m);
        EXPECT_NEAR(felt.push_m, std::max(-depth_m, slope_m), 1e-9) << "a push stays a push";
        cut_off += slope_m < -depth_m ? 1 : 0;
        EXPECT_LE(std::abs(felt.raise_m.x()) + std::abs(felt.raise_m.y()), 0.75 * raised_m);
        for (const int axis : {0, 1})
        {
            const Vec3 aside = 1e-7 * Vec3::Unit(axis);
            const double slope = (rise_at(list, place + aside, kSphere, kWidth) -
                                  rise_at(list, place - aside, kSphere, kWidth)) /
                                 2e-7;
            EXPECT_NEAR(felt.raise_m[axis], -raised_m * slope, 2e-5 * raised_m) << i;
            steepest = std::max(steepest, std::abs(slope));
        }
    }
    EXPECT_GT(steepest, 0.02) << "hills that are felt";
    EXPECT_GT(cut_off, 0) << "planes so far ahead that they would pull";
}

TEST(ForceShading, look_at_no_more_faces_than_they_may_in_the_widest_and_the_narrowest)
{
    Random random = Random::seeded(3203);
    const TriangleList list = hills(1e-4, random);
    ASSERT_GT(list.size(), 4U * kMaxShadedFaces);
    const Vec3 place(0, 0, kSphere);
    const auto surface = surface_of(list, place, 0.05);
    const ObjectPose pose;
    const Material material;
    ProxyMemory memory;
    const PlacedSurface placed = placed_surface(pose, surface.get(), material, memory);
    const auto looks = [&](double width_m)
    {
        return ForceShading(width_m, {&placed, 1}, kInfinity)
            .at({place, Vec3::UnitZ(), kSphere, 0.0}, 1e-3)
            .looks;
    };
    EXPECT_LE(looks(kShadingWidthMin_m), 8U);
    // Faces with a common nearest corner are equally far: all of them or none.
    std::vector<double> distances;
    for (const auto& corners : list)
    {
        const Point<double> nearest =
            closest_on_triangle(plain(place), plain(to_vec3(corners[0])),
                                plain(to_vec3(corners[1])), plain(to_vec3(corners[2])));
        distances.push_back((place - Vec3(nearest[0], nearest[1], nearest[2])).norm());
    }
    std::ranges::sort(distances);
    const double farthest = distances[kMaxShadedFaces] - 1e-9;
    const auto nearer = std::ranges::lower_bound(distances, farthest) - distances.begin();
    EXPECT_LE(nearer, kMaxShadedFaces);
    EXPECT_EQ(looks(kShadingWidthMax_m), nearer);
}

TEST(ForceShading, take_steps_from_a_sphere_of_5000_faces_and_keep_the_sphere_out)
{
    constexpr double kSphere_m = 0.05;
    const TriangleList list = sphere(kSphere_m, 25);
    ASSERT_EQ(list.size(), 5'000U);
    for (const double depth_m : {1e-3, 2e-3})
    {
        const Ride plain = ride(list, kSphere_m, depth_m, 0.0);
        const Ride sut = ride(list, kSphere_m, depth_m, kWidth);
        std::printf("%.0f mm deep: steps %.2f -> %.2f mN, off the sphere's normal %.2f -> %.2f "
                    "mrad\n",
                    1e3 * depth_m, 1e3 * plain.largest_step_n, 1e3 * sut.largest_step_n,
                    1e3 * plain.worst_angle, 1e3 * sut.worst_angle);
        EXPECT_LT(sut.largest_step_n, (depth_m < 1.5e-3 ? 0.5 : 0.3) * plain.largest_step_n);
        EXPECT_LT(sut.worst_angle, 0.55 * plain.worst_angle);
        EXPECT_GT(sut.least_gap_m, -1e-5 * kSphere);
    }
}

TEST(ForceShading, leave_sharp_edges_and_flat_faces_as_they_are)
{
    for (const Vec3& hand : {Vec3(0.005, 0.002, 0.021), Vec3(0.0195, 0.001, 0.021),
                             Vec3(0.0208, 0.001, 0.0208), Vec3(0.0206, 0.0205, 0.0207)})
    {
        ProxyRig plain(cube(0.02), 1.5 * hand, {}, smooth_sphere(0.0));
        ProxyRig sut(cube(0.02), 1.5 * hand, {}, smooth_sphere(kWidth));
        const ToolOutput should = plain.settle(hand, 60);
        const ToolOutput is = sut.settle(hand, 60);
        EXPECT_GT(should.force_n.norm(), 0.1);
        expect_vector(is.force_n, should.force_n, 2e-4);
    }
}

TEST(ForceShading, make_no_energy_on_closed_ways)
{
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
    {
        SCOPED_TRACE(seed);
        Random random = Random::seeded(seed);
        const TriangleList list = hills(1.5e-4, random);
        const double plain_j = work_over(list, 0.0, 0.0, seed);
        const double smooth_j = work_over(list, kWidth, 0.0, seed);
        std::printf("work on the hand, twice round: %.3g J with facets, %.3g J smooth\n", plain_j,
                    smooth_j);
        EXPECT_LT(smooth_j, 1e-7);
        EXPECT_GT(smooth_j, -1e-6) << "of some 250 uJ that the spring holds";
        EXPECT_LT(work_over(list, kWidth, 0.1, seed), 0.0);
    }
}

TEST(ForceShading, never_let_a_sphere_in_and_never_pull)
{
    const std::uint64_t seed = seed_of(3202);
    std::printf("TACTUS_SEED=%llu\n", static_cast<unsigned long long>(seed));
    Random random = Random::seeded(seed);
    std::uint32_t touched = 0;
    for (int round = 0; round < 30; ++round)
    {
        const TriangleList list = hills(random.between(1e-5, 5e-3), random);
        ProxyRig rig(list, Vec3(0, 0, 0.02), {}, smooth_sphere(random.between(1e-4, 0.03)));
        rig.certified = random.between(0.004, 0.02);
        rig.material().static_friction = random.one_in(2) ? 0.3 : 0.0;
        rig.material().dynamic_friction = 0.5 * rig.material().static_friction;
        Vec3 hand(0, 0, 0.02);
        Vec3 aim = hand;
        for (int frame = 0; frame < 400; ++frame)
        {
            if (random.one_in(25))
            {
                aim = Vec3{random.between(-0.015, 0.015), random.between(-0.015, 0.015),
                           random.between(-0.006, 0.008)};
            }
            hand += 0.15 * (aim - hand);
            const ToolOutput output = rig.step(hand);
            ASSERT_GT(rig.clearance(), kSphere * (1.0 - 1e-5)) << round << ' ' << frame;
            ASSERT_LE(output.force_n.norm(), 8.0 + 1e-9);
            touched += output.in_contact ? 1 : 0;
        }
        const ToolOutput rest = rig.settle(hand, 60);
        ASSERT_GE(rest.force_n.dot(rest.proxy_m - hand), 0.0) << round;
    }
    EXPECT_GT(touched, 3'000U);
}

} // namespace tactus::test
