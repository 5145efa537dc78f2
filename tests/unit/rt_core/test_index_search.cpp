// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/index_search.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kFrame = 1'000;
constexpr std::uint32_t kPagesInRound = 5;

IndexSearch::Balls one_ball(double x, double radius = 10.0, std::uint32_t level = 0)
{
    IndexSearch::Balls balls;
    balls.push_back({{{x, 0.0, 0.0}, radius}, level});
    return balls;
}

/// Frames in which so many pages are looked at.
class SearchRig
{
public:
    std::vector<std::uint32_t> look(const IndexSearch::Balls& balls,
                                    std::uint32_t pages = kPagesInRound, bool keeps_rounds = true)
    {
        ++frame;
        sut.aim(balls, kPagesInRound, frame, keeps_rounds);
        std::vector<std::uint32_t> looked;
        while (looked.size() < pages && !sut.is_at_rest())
        {
            looked.push_back(sut.next(frame).value);
        }
        return looked;
    }

    IndexSearch sut{kFrame};
    std::uint32_t frame{kFrame};
};

using PagesInTurn = std::vector<std::uint32_t>;

TEST(IndexSearch, rests_without_balls)
{
    SearchRig rig;
    EXPECT_TRUE(rig.look({}).empty());
    EXPECT_EQ(rig.sut.last_round_began(), rig.frame) << "nothing was of use before";
}

TEST(IndexSearch, goes_round_in_parts_and_then_rests)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_ball(0), 2), (PagesInTurn{0, 1}));
    EXPECT_EQ(rig.look(one_ball(0), 2), (PagesInTurn{2, 3}));
    EXPECT_EQ(rig.look(one_ball(0), 2), PagesInTurn{4});
    for (std::uint32_t i = 0; i < IndexSearch::kRestFrames; ++i)
    {
        EXPECT_TRUE(rig.look(one_ball(0)).empty()) << i;
    }
    EXPECT_EQ(rig.look(one_ball(0)), (PagesInTurn{0, 1, 2, 3, 4}));
}

TEST(IndexSearch, begins_anew_when_a_ball_leaves_what_the_round_was_for)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_ball(0)).size(), kPagesInRound);
    EXPECT_TRUE(rig.look(one_ball(0.99)).empty()) << "a tenth of the radius wider";
    EXPECT_EQ(rig.look(one_ball(1.01)).size(), kPagesInRound);
    EXPECT_EQ(rig.look(one_ball(1.01, 11.2)).size(), kPagesInRound);
    EXPECT_TRUE(rig.look(one_ball(1.01, 3.0)).empty());
}

TEST(IndexSearch, begins_anew_for_other_balls)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_ball(0)).size(), kPagesInRound);
    EXPECT_EQ(rig.look(one_ball(0, 10.0, 1)).size(), kPagesInRound) << "another level";
    IndexSearch::Balls two = one_ball(0, 10.0, 1);
    two.push_back(two[0]);
    EXPECT_EQ(rig.look(two).size(), kPagesInRound);
    EXPECT_TRUE(rig.look({}).empty());
    EXPECT_EQ(rig.look(two).size(), kPagesInRound);
}

TEST(IndexSearch, begins_anew_when_told)
{
    SearchRig rig;
    EXPECT_EQ(rig.look(one_ball(0)).size(), kPagesInRound);
    rig.sut.begin_anew();
    EXPECT_EQ(rig.look(one_ball(0)).size(), kPagesInRound);
}

/// A small box there, and its chunk.
IndexSearch::Beside beside_at(std::int32_t x)
{
    return {ChunkId{static_cast<std::uint32_t>(x)}, {{x, 0, 0}, {x, 0, 0}}};
}

TEST(IndexSearch, gives_each_chunk_beside_once_when_a_ball_has_come_to_it)
{
    SearchRig rig;
    const IndexSearch::Balls here = one_ball(0, 100.0);
    const IndexSearch::Balls there = one_ball(5.5, 100.0);
    rig.look(here);
    rig.sut.add_beside(beside_at(108));
    rig.sut.add_beside(beside_at(105));
    EXPECT_FALSE(rig.sut.take_met()) << "no ball of the frame meets them";
    EXPECT_TRUE(rig.look(there).empty());
    const auto met = rig.sut.take_met();
    ASSERT_TRUE(met);
    EXPECT_EQ(met->chunk, ChunkId{105});
    EXPECT_EQ(met->ball.ball.center[0], 5.5);
    EXPECT_FALSE(rig.sut.take_met()) << "the other one is not met yet";
}

TEST(IndexSearch, forgets_what_is_beside_when_a_round_begins_and_begins_one_when_it_is_too_much)
{
    SearchRig rig;
    const IndexSearch::Balls near = one_ball(0);
    const IndexSearch::Balls far = one_ball(20);
    rig.look(near);
    rig.sut.add_beside(beside_at(25));
    EXPECT_EQ(rig.look(far).size(), kPagesInRound);
    EXPECT_FALSE(rig.sut.take_met());
    for (std::size_t i = 0; i < IndexSearch::kMaxBeside; ++i)
    {
        rig.sut.add_beside(beside_at(40));
    }
    EXPECT_TRUE(rig.look(far).empty());
    rig.sut.add_beside(beside_at(40));
    EXPECT_EQ(rig.look(far).size(), kPagesInRound);
}

TEST(IndexSearch, is_for_wider_balls_and_knows_those_of_the_frame)
{
    SearchRig rig;
    const IndexSearch::Balls first = one_ball(0);
    rig.look(first, 1);
    const IndexSearch::Balls second = one_ball(0.5);
    rig.look(second, 1);
    EXPECT_EQ(rig.sut.balls()[0].ball.center[0], 0.0);
    EXPECT_DOUBLE_EQ(rig.sut.balls()[0].ball.radius, 11.0);
    EXPECT_EQ(rig.sut.aimed_at()[0].ball.center[0], 0.5);
    EXPECT_EQ(rig.sut.aimed_at()[0].ball.radius, 10.0);
}

TEST(IndexSearch, keeps_no_round_when_told_so_or_for_too_many_balls)
{
    SearchRig rig;
    const IndexSearch::Balls one = one_ball(0); // The search looks at it, too.
    EXPECT_EQ(rig.look(one, kPagesInRound, false).size(), kPagesInRound);
    EXPECT_EQ(rig.look(one, kPagesInRound, false).size(), kPagesInRound);
    EXPECT_EQ(rig.sut.balls()[0].ball.radius, 10.0);
    IndexSearch::Balls many;
    for (std::size_t i = 0; i <= IndexSearch::kKeptBalls; ++i)
    {
        many.push_back(one_ball(0)[0]);
    }
    EXPECT_EQ(rig.look(many).size(), kPagesInRound);
    EXPECT_EQ(rig.look(many).size(), kPagesInRound);
    EXPECT_EQ(rig.sut.balls().size(), many.size());
}

TEST(IndexSearch, tells_when_the_round_before_the_last_began)
{
    SearchRig rig;
    rig.look(one_ball(0), kPagesInRound, false);
    rig.look(one_ball(0), kPagesInRound, false);
    EXPECT_EQ(rig.sut.last_round_began(), kFrame + 1);
    rig.look(one_ball(0), kPagesInRound, false);
    EXPECT_EQ(rig.sut.last_round_began(), kFrame + 2);
}

} // namespace
} // namespace tactus::test
