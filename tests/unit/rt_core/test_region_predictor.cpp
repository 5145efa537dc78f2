// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/predict/region_predictor.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

CoreCover one_ball(const Vec3& center)
{
    CoreCover balls;
    balls.push_back({center, 0.0});
    return balls;
}

} // namespace

TEST(RegionPredictor, before_and_after_the_first_observation_stands_still)
{
    RegionPredictor sut;
    sut.observe(Vec3(1, 2, 3), 0.001);
    RegionRanking ranking;

    sut.rank({5}, one_ball(Vec3(1, 2, 3)), 0.02, ranking);

    ASSERT_EQ(ranking.size(), 3U);
    for (const RankedRegion& region : ranking)
    {
        EXPECT_EQ(region.model, ModelId{5});
        EXPECT_EQ(region.center_m, Vec3(1, 2, 3));
        EXPECT_EQ(region.radius_m, 0.02);
    }
}

TEST(RegionPredictor, finds_a_constant_velocity_and_the_places_it_leads_to)
{
    const Vec3 velocity(0.3, -0.2, 0.1);
    RegionPredictor sut;
    Vec3 at(0, 0, 0);
    for (int i = 0; i < 300; ++i)
    {
        at += velocity * 0.001;
        sut.observe(at, 0.001);
    }
    EXPECT_NEAR((sut.velocity_m_per_s() - velocity).norm(), 0.0, 1e-9);
    RegionRanking ranking;

    sut.rank({0}, one_ball(at), 0.02, ranking);

    ASSERT_EQ(ranking.size(), 3U);
    std::int64_t last = -1;
    for (const RankedRegion& region : ranking)
    {
        const Vec3 way = velocity * (static_cast<double>(region.lead_ns) * 1e-9);
        EXPECT_NEAR((region.center_m - (at + way)).norm(), 0.0, 1e-9);
        EXPECT_NEAR(region.radius_m, 0.02 + 0.1 * way.norm(), 1e-9);
        EXPECT_GT(region.lead_ns, last) << "most urgent first";
        last = region.lead_ns;
    }
    EXPECT_EQ(ranking[0].lead_ns, 0);
}

TEST(RegionPredictor, a_stall_counts_with_its_whole_time)
{
    RegionPredictor sut;
    sut.observe(Vec3(0, 0, 0), 0.001);

    sut.observe(Vec3(0.5, 0, 0), 0.5);

    EXPECT_GT(sut.velocity_m_per_s().x(), 0.9);
    EXPECT_LE(sut.velocity_m_per_s().x(), 1.0);
}

TEST(RegionPredictor, smooths_a_tremor_away)
{
    RegionPredictor sut;
    for (int i = 0; i < 1'000; ++i)
    {
        sut.observe(Vec3(i % 2 == 0 ? 1e-4 : -1e-4, 0, 0), 0.001);
    }
    EXPECT_LT(sut.velocity_m_per_s().norm(), 0.1 * 0.2);
}

TEST(RegionPredictor, a_full_ranking_keeps_what_it_has)
{
    RegionPredictor sut;
    sut.observe(Vec3(1, 0, 0), 0.001);
    RegionRanking ranking;
    while (ranking.try_push_back({ModelId{9}, Vec3(0, 0, 0), 1.0, 0}))
    {
    }

    sut.rank({0}, one_ball(Vec3(1, 0, 0)), 0.02, ranking);

    EXPECT_TRUE(ranking.full());
    EXPECT_EQ(ranking[ranking.size() - 1].model, ModelId{9});
}

TEST(RegionPredictorDeathTest, time_that_stands_still_is_a_bug)
{
    RegionPredictor sut;
    EXPECT_DEATH(sut.observe(Vec3(0, 0, 0), 0.0), "");
}

} // namespace tactus::test
