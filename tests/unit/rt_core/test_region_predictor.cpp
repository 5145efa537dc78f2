// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/predict/region_predictor.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace tactus::test
{

namespace
{

constexpr double kHorizon_s = 0.02;
constexpr double kSpeedMax_m_per_s = 10.0;
/// One sphere at the tool, and one for each quarter of the horizon.
constexpr std::size_t kSpheres = 5;
constexpr std::size_t kHalfway = 2;
constexpr std::size_t kLast = 4;

constexpr std::array<Prediction, 5> kWays{Prediction::local_neighbours, Prediction::linear,
                                          Prediction::quadratic, Prediction::distance_query,
                                          Prediction::automatic};

CoreCover one_sphere(const Vec3& center)
{
    CoreCover spheres;
    spheres.push_back({center, 0.0});
    return spheres;
}

PairMotion motion_to(const Vec3& center_m)
{
    PairMotion motion;
    motion.center_m = center_m;
    motion.speed_max_m_per_s = kSpeedMax_m_per_s;
    motion.elapsed_s = kPeriod_s;
    return motion;
}

/// Observes a path, one place for each frame.
void follow(RegionPredictor& sut, const std::function<Vec3(double)>& place_at, int frames)
{
    for (int i = 0; i <= frames; ++i)
    {
        sut.observe(motion_to(place_at(i * kPeriod_s)), kHorizon_s);
    }
}

RegionRanking ranked(const RegionPredictor& sut, Prediction way, const Vec3& at)
{
    RegionRanking ranking;
    sut.rank(way, {5}, one_sphere(at), 0.02, ranking);
    return ranking;
}

Vec3 on_circle(double time_s)
{
    return {0.1 * std::cos(10.0 * time_s), 0.1 * std::sin(10.0 * time_s), 0.0};
}

} // namespace

TEST(RegionPredictor, after_the_first_observation_every_way_stands_still_the_most_urgent_first)
{
    RegionPredictor sut;
    sut.observe(motion_to(Vec3(1, 2, 3)), kHorizon_s);

    for (const Prediction way : kWays)
    {
        const RegionRanking ranking = ranked(sut, way, Vec3(1, 2, 3));

        ASSERT_EQ(ranking.size(), kSpheres);
        for (std::size_t i = 0; i < kSpheres; ++i)
        {
            EXPECT_EQ(ranking[i].model, ModelId{5});
            EXPECT_EQ(ranking[i].center_m, Vec3(1, 2, 3));
            EXPECT_EQ(ranking[i].radius_m, 0.02);
            EXPECT_EQ(ranking[i].horizon_ns, 5'000'000 * static_cast<std::int64_t>(i));
        }
    }
}

TEST(RegionPredictor, linear_finds_a_constant_velocity_and_the_places_it_leads_to)
{
    const Vec3 velocity(0.3, -0.2, 0.1);
    RegionPredictor sut;
    follow(
        sut, [&](double time_s) { return Vec3(velocity * time_s); }, 600);
    const Vec3 at = velocity * 0.6;

    EXPECT_NEAR((sut.velocity_m_per_s() - velocity).norm(), 0.0, 1e-9);
    for (const RankedRegion& region : ranked(sut, Prediction::linear, at))
    {
        const Vec3 way = velocity * (static_cast<double>(region.horizon_ns) * 1e-9);
        EXPECT_NEAR((region.center_m - (at + way)).norm(), 0.0, 1e-9);
        EXPECT_NEAR(region.radius_m, 0.02, 1e-3) << "what it erred while it learned wears off";
    }
}

TEST(RegionPredictor, quadratic_foretells_an_acceleration_that_linear_misses)
{
    const Vec3 acceleration(3.0, 0.0, -2.0);
    const auto place_at = [&](double time_s) -> Vec3
    { return 0.5 * time_s * time_s * acceleration; };
    RegionPredictor sut;
    follow(sut, place_at, 600);
    const Vec3 truth = place_at(0.6 + kHorizon_s);

    const Vec3 linear = ranked(sut, Prediction::linear, place_at(0.6))[kLast].center_m;
    const Vec3 quadratic = ranked(sut, Prediction::quadratic, place_at(0.6))[kLast].center_m;

    const double missed_by_linear = (linear - truth).norm();
    EXPECT_GT(missed_by_linear, 0.5 * 0.5 * kHorizon_s * kHorizon_s * acceleration.norm());
    EXPECT_LT((quadratic - truth).norm(), 0.2 * missed_by_linear);
}

TEST(RegionPredictor, local_neighbours_stay_and_reach_as_far_as_the_speed_leads)
{
    RegionPredictor sut;
    follow(
        sut, [](double time_s) { return Vec3(0.5 * time_s, 0.0, 0.0); }, 300);

    const RegionRanking ranking = ranked(sut, Prediction::local_neighbours, Vec3(0.15, 0.0, 0.0));

    EXPECT_EQ(ranking[kLast].center_m, Vec3(0.15, 0.0, 0.0));
    EXPECT_NEAR(ranking[kLast].radius_m, 0.02 + 0.5 * kHorizon_s, 1e-9);
    EXPECT_NEAR(ranking[kHalfway].radius_m, 0.02 + 0.25 * kHorizon_s, 1e-9);
}

TEST(RegionPredictor, distance_query_does_not_go_through_the_surface)
{
    RegionPredictor through;
    PairMotion motion = motion_to(Vec3(0, 0, 0));
    for (int i = 0; i < 300; ++i)
    {
        motion.center_m = Vec3(0.4 * i * kPeriod_s, 0.0, 1.0 - 0.3 * i * kPeriod_s);
        motion.outward = Vec3(0, 0, 1);
        motion.gap_m = 0.002;
        through.observe(motion, kHorizon_s);
    }

    const Vec3 straight =
        ranked(through, Prediction::linear, motion.center_m)[kLast].center_m - motion.center_m;
    const Vec3 held = ranked(through, Prediction::distance_query, motion.center_m)[kLast].center_m -
                      motion.center_m;

    EXPECT_NEAR(straight.z(), -0.3 * kHorizon_s, 1e-9);
    EXPECT_NEAR(held.z(), -0.002, 1e-9) << "as far as touching";
    EXPECT_NEAR(held.x(), straight.x(), 1e-9);
}

/// A tool that waits for data follows its hand at its own speed.
TEST(RegionPredictor, a_tool_behind_its_hand_is_expected_on_the_way_to_it)
{
    RegionPredictor sut;
    PairMotion motion = motion_to(Vec3(0, 0, 0));
    motion.way_m = Vec3(0.3, 0.0, 0.0);
    motion.speed_max_m_per_s = 2.0;
    for (int i = 0; i < 100; ++i)
    {
        sut.observe(motion, kHorizon_s);
    }

    const RegionRanking ranking = ranked(sut, Prediction::linear, Vec3(0, 0, 0));

    EXPECT_NEAR(ranking[kLast].center_m.x(), 2.0 * kHorizon_s, 1e-12);
    EXPECT_NEAR(ranking[kHalfway].center_m.x(), 1.0 * kHorizon_s, 1e-12);
}

TEST(RegionPredictor, automatic_believes_the_way_that_errs_least)
{
    RegionPredictor straight;
    follow(
        straight, [](double time_s) { return Vec3(0.3 * time_s, 0.0, 0.0); }, 600);
    EXPECT_NE(straight.limited(), Prediction::local_neighbours);

    RegionPredictor turning;
    follow(turning, on_circle, 600);
    EXPECT_EQ(turning.limited(), Prediction::quadratic);

    Random random(7);
    RegionPredictor trembling;
    follow(
        trembling, [&](double) { return random.in_cube(1e-3); }, 2'000);
    EXPECT_EQ(trembling.limited(), Prediction::local_neighbours);
}

TEST(RegionPredictor, automatic_ranks_as_the_way_it_believes)
{
    RegionPredictor sut;
    follow(sut, on_circle, 600);
    const Vec3 at = on_circle(0.6);

    const RegionRanking automatic = ranked(sut, Prediction::automatic, at);
    const RegionRanking limited = ranked(sut, sut.limited(), at);

    for (std::size_t i = 0; i < kSpheres; ++i)
    {
        EXPECT_EQ(automatic[i].center_m, limited[i].center_m);
        EXPECT_EQ(automatic[i].radius_m, limited[i].radius_m);
    }
}

TEST(RegionPredictor, spheres_are_wider_by_what_forecasts_erred)
{
    RegionPredictor sut;
    follow(sut, on_circle, 2'000);
    const double before_m = (on_circle(2.0 - kHorizon_s) - on_circle(2.0)).norm();

    const RegionRanking ranking = ranked(sut, Prediction::linear, on_circle(2.0));
    const double erred_m = (ranking[kLast].center_m - on_circle(2.0 + kHorizon_s)).norm();

    EXPECT_GT(ranking[kLast].radius_m - 0.02, 0.8 * erred_m);
    EXPECT_LT(ranking[kLast].radius_m - 0.02, 1.2 * erred_m);
    EXPECT_LT(erred_m, before_m) << "better than staying";
}

TEST(RegionPredictor, no_sphere_is_wider_than_by_as_much_as_is_asked_for)
{
    RegionPredictor sut;
    follow(
        sut, [](double time_s) { return Vec3(5.0 * time_s, 0.0, 0.0); }, 300);
    const Vec3 at(1.5, 0.0, 0.0);

    EXPECT_NEAR(ranked(sut, Prediction::local_neighbours, at)[kLast].radius_m, 0.04, 1e-12);
}

TEST(RegionPredictor, a_stall_counts_with_its_whole_time)
{
    RegionPredictor sut;
    sut.observe(motion_to(Vec3(0, 0, 0)), kHorizon_s);
    PairMotion later = motion_to(Vec3(0.5, 0, 0));
    later.elapsed_s = 0.5;

    sut.observe(later, kHorizon_s);

    EXPECT_GT(sut.velocity_m_per_s().x(), 0.9);
    EXPECT_LE(sut.velocity_m_per_s().x(), 1.0);
}

TEST(RegionPredictor, smooths_a_tremor_away)
{
    RegionPredictor sut;
    for (int i = 0; i < 1'000; ++i)
    {
        sut.observe(motion_to(Vec3(i % 2 == 0 ? 1e-4 : -1e-4, 0, 0)), kHorizon_s);
    }
    EXPECT_LT(sut.velocity_m_per_s().norm(), 0.1 * 0.2);
}

TEST(RegionPredictor, a_full_ranking_keeps_what_it_has)
{
    RegionPredictor sut;
    sut.observe(motion_to(Vec3(1, 0, 0)), kHorizon_s);
    RegionRanking ranking;
    while (ranking.try_push_back({ModelId{9}, Vec3(0, 0, 0), 1.0, 0}))
    {
    }

    sut.rank(Prediction::automatic, {0}, one_sphere(Vec3(1, 0, 0)), 0.02, ranking);

    EXPECT_TRUE(ranking.full());
    EXPECT_EQ(ranking[ranking.size() - 1].model, ModelId{9});
}

TEST(RegionPredictor, a_full_ranking_says_when_it_lacks_a_sphere_where_a_tool_is)
{
    RegionPredictor sut;
    sut.observe(motion_to(Vec3(1, 0, 0)), kHorizon_s);
    RegionRanking ranking;
    while (ranking.size() + 1 < kMaxRankedRegions)
    {
        ranking.push_back({ModelId{9}, Vec3(0, 0, 0), 1.0, 0});
    }

    sut.rank(Prediction::automatic, {0}, one_sphere(Vec3(1, 0, 0)), 0.02, ranking);

    EXPECT_EQ(ranking.size(), kMaxRankedRegions);
    EXPECT_FALSE(ranking.lacks_present) << "only spheres that look ahead were left out";
    RegionPredictor::rank_present({0}, one_sphere(Vec3(1, 0, 0)), 0.02, ranking);
    EXPECT_EQ(ranking.size(), kMaxRankedRegions);
    EXPECT_TRUE(ranking.lacks_present);
}

TEST(RegionPredictorDeathTest, time_that_stands_still_is_a_bug)
{
    RegionPredictor sut;
    PairMotion motion = motion_to(Vec3(0, 0, 0));
    motion.elapsed_s = 0.0;
    EXPECT_DEATH(sut.observe(motion, kHorizon_s), "");
    EXPECT_DEATH(sut.observe(motion_to(Vec3(0, 0, 0)), 0.0), "");
}

} // namespace tactus::test
