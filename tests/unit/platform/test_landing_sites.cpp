// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/simulated/landing_sites.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tactus
{

namespace
{

std::vector<Vec3> random_points(std::uint32_t seed, std::size_t count)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> axis(-1.0, 1.0);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i)
    {
        points.emplace_back(0.3 * axis(random) + 5.0, axis(random), 2.0 * axis(random));
    }
    return points;
}

double distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b)
{
    const Vec3 along = b - a;
    const double t = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (a + along * t - point).norm();
}

TEST(LandingSites, offers_the_side_across_the_shortest_extent_first)
{
    const auto points = random_points(1, 200);
    const auto sites = find_landing_sites(points, 5.0, 0.05);
    const Vec3 approach = (sites.front().aim_world_m - sites.front().gate_world_m).normalized();
    EXPECT_EQ(sites.size(), 12U);
    EXPECT_GT(sites.front().gate_world_m.x(), 5.3);
    EXPECT_LT(approach.x(), 0.0);
}

TEST(LandingSites, puts_every_gate_outside_the_box_and_on_its_orbit)
{
    const auto points = random_points(2, 200);
    const Vec3 centre = centre_of(points);
    for (const LandingSite& site : find_landing_sites(points, 5.0, 0.05))
    {
        EXPECT_NEAR((site.gate_world_m - centre).norm(), site.orbit_radius_m, 1e-12);
        EXPECT_GE(site.orbit_radius_m, 0.55 * 5.0);
    }
}

TEST(LandingSites, keeps_the_way_from_gate_to_anchor_free_of_all_other_points)
{
    for (std::uint32_t seed = 0; seed < 20; ++seed)
    {
        const auto points = random_points(seed, 300);
        const auto sites = find_landing_sites(points, 5.0, 0.05);
        for (std::size_t i = 1; i < sites.size(); i += 2) // The unshifted ones.
        {
            const LandingSite& site = sites[i];
            for (const Vec3& point : points)
            {
                const double along = (site.gate_world_m - site.aim_world_m)
                                         .normalized()
                                         .dot(point - site.aim_world_m);
                const double distance =
                    distance_to_segment(point, site.gate_world_m, site.aim_world_m);
                EXPECT_TRUE(distance >= (point - site.aim_world_m).norm() * 0.05 || along <= 0.0)
                    << "seed " << seed << " site " << i;
            }
        }
    }
}

TEST(LandingSites, works_for_a_single_point)
{
    const std::vector<Vec3> one{Vec3(1.0, 2.0, 3.0)};
    const auto sites = find_landing_sites(one, 0.1, 0.001);
    ASSERT_FALSE(sites.empty());
    for (const LandingSite& site : sites)
    {
        EXPECT_EQ(site.aim_world_m, one.front());
        EXPECT_TRUE(site.gate_world_m.allFinite());
    }
}

} // namespace

} // namespace tactus
