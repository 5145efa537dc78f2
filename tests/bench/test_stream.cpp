// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/stream_run.hpp"
#include "tests/bench/tap_tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tactus::bench
{

namespace
{

/// A square of two faces, a metre wide, in the plane z = 0.
std::vector<test::Face> square()
{
    const Vec3f a{-0.5F, -0.5F, 0.0F};
    const Vec3f b{0.5F, -0.5F, 0.0F};
    const Vec3f c{0.5F, 0.5F, 0.0F};
    const Vec3f d{-0.5F, 0.5F, 0.0F};
    return {test::Face{a, b, c}, test::Face{a, c, d}};
}

/// Frames as a streaming model gives them, one after another.
class Frames
{
public:
    explicit Frames(const TapTour& tour) : counter(tour) {}

    void add(AnswerKind kind, bool waits = false, std::vector<std::uint32_t> arrivals = {})
    {
        PairOutput pair;
        pair.kind = kind;
        ToolOutput tool;
        tool.held_back = waits;
        const ModelOutput model;
        std::vector<DoorEvent> events;
        for (const std::uint32_t chunk : arrivals)
        {
            events.push_back({{ContentKind::chunk, chunk}});
        }
        const DoorTake take{events, 0};
        FrameOutput output;
        output.tools = {&tool, 1};
        output.pairs = {&pair, 1};
        output.models = {&model, 1};
        output.door = take;
        counter.add(output);
    }

    StreamCounter counter;
};

} // namespace

TEST(TapTour, taps_where_it_says_and_moves_no_faster_than_it_should)
{
    const std::vector<test::Face> faces = square();
    const test::FaceTree tree(faces);
    const TouchScene scene{tree, 1.5};
    TourManner manner;
    manner.speed_diag_per_s = 0.2;
    manner.taps = 4;

    const TapTour sut = tap_tour(scene, manner);

    ASSERT_EQ(sut.touches.size(), 4U);
    const double reach_m = kRadius_diag * scene.diagonal_m;
    for (const std::size_t touch : sut.touches)
    {
        EXPECT_LE(tree.nearest(sut.goals_m[touch]).distance_m, reach_m);
        EXPECT_GT(tree.nearest(sut.goals_m[touch - 1]).distance_m, reach_m);
    }
    const double step_m = 0.2 * scene.diagonal_m * kPeriod_s;
    double longest_m = 0.0;
    for (std::size_t i = 1; i < sut.goals_m.size(); ++i)
    {
        longest_m = std::max(longest_m, (sut.goals_m[i] - sut.goals_m[i - 1]).norm());
    }
    EXPECT_GT(longest_m, 0.9 * step_m);
    EXPECT_LT(longest_m, 3.0 * step_m) << "the swing in depth and edges add to it";
}

TEST(StreamCounter, counts_answers_and_late_taps)
{
    TapTour tour;
    tour.touches = {1, 3, 4};
    Frames sut(tour);
    sut.add(AnswerKind::decided);
    sut.add(AnswerKind::exact);
    sut.add(AnswerKind::bracket, true);
    sut.add(AnswerKind::bracket);
    sut.add(AnswerKind::exact, true);
    sut.add(AnswerKind::stale);

    const StreamFigures& figures = sut.counter.figures();
    EXPECT_EQ(figures.frames, 6U);
    EXPECT_EQ(figures.exact, 2U);
    EXPECT_EQ(figures.open, 3U);
    EXPECT_EQ(figures.waiting, 2U);
    EXPECT_EQ(figures.taps, 3U);
    EXPECT_EQ(figures.late_taps, 2U) << "one open, one that waited";
    EXPECT_DOUBLE_EQ(figures.percent(figures.open), 50.0);
    EXPECT_DOUBLE_EQ(figures.per_second(figures.open), 500.0);
}

TEST(StreamCounter, counts_reloads_and_their_bursts)
{
    const TapTour tour;
    Frames sut(tour);
    sut.add(AnswerKind::exact, false, {7, 8});
    sut.add(AnswerKind::exact, false, {7});
    sut.add(AnswerKind::exact, false, {8, 9});
    for (int i = 0; i < 600; ++i)
    {
        sut.add(AnswerKind::exact);
    }
    sut.add(AnswerKind::exact, false, {9});

    const StreamFigures& figures = sut.counter.figures();
    EXPECT_EQ(figures.loads, 6U);
    EXPECT_EQ(figures.reloads, 3U);
    EXPECT_EQ(figures.reload_bursts, 2U);
}

} // namespace tactus::bench
