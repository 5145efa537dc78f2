// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A texture is what its energy says. The oracle is that energy, written down here once more and
/// derived by differences.

#include "rt_core/force/texture.hpp"
#include "tests/unit/rt_core/proxy_rig.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tactus::test
{

namespace
{

/// Over the stiffness: e(d) h(p).
double energy(const Material& material, const ObjectPose& pose, const Vec3& at_m, double depth_m)
{
    const Vec3 there_m = pose.rotation.inverse() * (at_m - pose.translation_m);
    double height_m = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double turns = there_m[axis] / material.texture_length_m;
        const double t = turns - std::floor(turns);
        height_m += material.texture_height_m * (16.0 * std::pow(t * (1.0 - t), 2) - 0.5);
    }
    const double most_m =
        std::pow(material.texture_length_m, 2) / (64.0 * material.texture_height_m);
    return most_m * std::pow(depth_m / (most_m + depth_m), 2) * height_m;
}

Material bumpy(double height_m, double length_m)
{
    Material material;
    material.texture_height_m = height_m;
    material.texture_length_m = length_m;
    return material;
}

Material random_bumps(Random& random)
{
    const double length_m = random.between(2e-4, 0.01);
    return bumpy(random.between(0.01, 1.0) * kTextureSteepest * length_m, length_m);
}

ObjectPose random_pose(Random& random)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.in_cube(1.0).normalized())
                        .toRotationMatrix();
    pose.translation_m = random.in_cube(0.1);
    return pose;
}

/// A tool small beside the bumps, so that what the proxy leaves of a step is small, too.
ToolSpec pin()
{
    ToolSpec spec = ball_tool();
    spec.radius_m = 5e-4;
    return spec;
}

} // namespace

TEST(Texture, is_the_derivative_of_its_energy_and_keeps_within_its_bounds)
{
    Random random(2501);
    for (int i = 0; i < 2'000; ++i)
    {
        const Material material = random_bumps(random);
        const ObjectPose pose = random_pose(random);
        const Vec3 at_m = random.in_cube(0.1);
        const double depth_m = random.between(1e-6, 0.02);
        const double small_m = 1e-4 * material.texture_length_m;
        const auto sut = Texture::at(material, pose, at_m, depth_m);
        const auto by_depth = [&](double step_m)
        { return energy(material, pose, at_m, depth_m + step_m); };
        const double step_m = std::min(small_m, 0.1 * depth_m);
        EXPECT_NEAR(sut.push_m, (by_depth(step_m) - by_depth(-step_m)) / (2.0 * step_m),
                    1e-5 * material.texture_height_m);
        EXPECT_GE(depth_m + sut.push_m, 0.0) << "a push stays a push";
        EXPECT_LE(1.0 + (Texture::at(material, pose, at_m, depth_m + step_m).push_m -
                         Texture::at(material, pose, at_m, depth_m - step_m).push_m) /
                            (2.0 * step_m),
                  Texture::stiffening(material) + 1e-6);
        for (int axis = 0; axis < 3; ++axis)
        {
            const Vec3 aside_m = small_m * Vec3::Unit(axis);
            const double slope = (energy(material, pose, at_m + aside_m, depth_m) -
                                  energy(material, pose, at_m - aside_m, depth_m)) /
                                 (2.0 * small_m);
            EXPECT_NEAR(sut.slope_m[axis], slope, 1e-4 * material.texture_height_m);
            const Vec3 bend = (Texture::at(material, pose, at_m + aside_m, depth_m).slope_m -
                               Texture::at(material, pose, at_m - aside_m, depth_m).slope_m) /
                              (2.0 * small_m);
            EXPECT_LE(bend.norm(), 0.5 + 1e-6) << "one place of rest for a hand";
        }
        EXPECT_LE(Texture::stiffening(material), 1.2);
    }
    EXPECT_EQ(Texture::stiffening(Material{}), 1.0);
    EXPECT_EQ(Texture::at(Material{}, {}, Vec3(1, 2, 3), 0.01).push_m, 0.0);
}

/// A material that fades away passes every height, denormal ones too; D is then beyond all numbers.
TEST(Texture, of_any_height_is_a_number_and_no_more_than_the_bumps)
{
    Random random(2502);
    for (const double length_m : {kTextureLengthMin_m, 1e-3, kTextureLengthMax_m})
    {
        const double highest_m = kTextureSteepest * length_m;
        for (double height_m = highest_m; height_m > 0.0; height_m *= random.between(0.0, 0.2))
        {
            const Material material = bumpy(height_m, length_m);
            ASSERT_TRUE(is_sound(material)) << height_m;
            for (const double depth_m : {0.0, 5e-324, 1e-300, 1e-9, 1e-3, 1.0, 1e4})
            {
                const auto sut =
                    Texture::at(material, random_pose(random), random.in_cube(0.1), depth_m);
                ASSERT_LE(std::abs(sut.push_m), 1.5 * height_m) << height_m << ' ' << depth_m;
                ASSERT_LE(sut.slope_m.cwiseAbs().maxCoeff(), 0.5 * length_m)
                    << height_m << ' ' << depth_m;
            }
            ASSERT_LE(Texture::stiffening(material), 1.2);
        }
    }
}

TEST(Texture, is_felt_where_spring_and_bumps_are_in_balance)
{
    const Material material = bumpy(5e-5, 2e-3);
    constexpr double kDepth = 1.5e-3;
    double most_n = 0.0;
    for (int i = 0; i < 40; ++i)
    {
        ProxyRig rig(plane(), Vec3(0, 0, 0.01), {}, pin());
        rig.material = material;
        const Vec3 hand(1e-4 * i, 0.0, rig.sut.radius_m() - kDepth);
        const ToolOutput output = rig.settle(hand, 60);
        // The proxy goes where its energy is least: by halving what is wrong.
        double proxy_m = hand.x();
        for (int round = 0; round < 100; ++round)
        {
            const Vec3 at(proxy_m, 0.0, rig.sut.radius_m());
            const double slope = (energy(material, {}, at + Vec3(1e-9, 0, 0), kDepth) -
                                  energy(material, {}, at - Vec3(1e-9, 0, 0), kDepth)) /
                                 2e-9;
            proxy_m += 0.5 * (hand.x() - slope - proxy_m);
        }
        EXPECT_NEAR(output.proxy_m.x(), proxy_m, 3.0 * kSlipShare * rig.sut.radius_m());
        EXPECT_NEAR(output.force_n.x(), kStiffness * (proxy_m - hand.x()), 2e-4);
        const Vec3 at(output.proxy_m);
        const double rise =
            (energy(material, {}, at, kDepth + 1e-9) - energy(material, {}, at, kDepth - 1e-9)) /
            2e-9;
        EXPECT_NEAR(output.force_n.z(), kStiffness * (kDepth + rise), 1e-4);
        EXPECT_NEAR(output.stiffness_n_per_m, kStiffness * Texture::stiffening(material), 1e-9);
        most_n = std::max(most_n, std::abs(output.force_n.x()));
    }
    EXPECT_GT(most_n, 0.01) << "bumps that are felt";
    EXPECT_LT(most_n, kStiffness * material.texture_length_m * 0.05);
}

/// Once round a closed way of the hand, several times over: what the force did on the hand. In
/// steps so short that what a held force makes between two samples is nothing beside it.
double work_of_rounds(const Material& material, const ObjectPose& pose, const TriangleList& list,
                      std::uint32_t seed)
{
    Random random(seed);
    // From bump to bump: in at a crest and out at a trough is what a false energy would show in.
    const Vec3 wide_m(random.between(4e-4, 1e-3), random.between(4e-4, 1e-3), 0.0);
    const double dip_m = random.between(2e-4, 8e-4);
    const double phase = random.between(0.0, 6.0);
    ProxyRig rig(list, pose.to_there(Vec3(0, 0, 0.01)), pose, pin());
    rig.material = material;
    const auto hand_at = [&](int step)
    {
        const double angle = 2.0 * std::numbers::pi * step / 8'000.0;
        return pose.to_there(Vec3(wide_m.x() * std::cos(angle), wide_m.y() * std::sin(angle),
                                  -1e-3 + dip_m * std::sin(angle + phase)));
    };
    (void)rig.settle(hand_at(0), 400);
    double work_j = 0.0;
    ToolOutput last = rig.step(hand_at(0));
    for (int step = 1; step <= 16'000; ++step)
    {
        const ToolOutput now = rig.step(hand_at(step));
        work_j += 0.5 * (now.force_n + last.force_n).dot(hand_at(step) - hand_at(step - 1));
        last = now;
    }
    return work_j;
}

TEST(Texture, makes_no_energy_on_closed_ways)
{
    for (std::uint32_t seed = 1; seed <= 4; ++seed)
    {
        SCOPED_TRACE(seed);
        Random random(seed);
        Material material = bumpy(6e-5, random.between(2e-3, 3e-3));
        const ObjectPose pose = random_pose(random);
        const double smooth_j = work_of_rounds(Material{}, pose, plane(), seed);
        const double bumpy_j = work_of_rounds(material, pose, plane(), seed);
        // 3 nJ are left, by what a proxy may lack of its place; a false push makes some 100.
        EXPECT_LT(std::abs(smooth_j), 1e-12);
        EXPECT_LT(std::abs(bumpy_j), 1e-8);
        material.static_friction = 0.1;
        material.dynamic_friction = 0.08;
        EXPECT_LT(work_of_rounds(material, pose, plane(), seed), 0.0);
    }
}

} // namespace tactus::test
