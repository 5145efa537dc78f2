// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/frame_fates.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::relay
{

namespace
{

constexpr std::size_t kFates = 100'000;

std::vector<FrameFate> fates_of(std::uint64_t seed, const LinkCondition& condition,
                                bool must_arrive = false)
{
    FrameFates sut(seed);
    std::vector<FrameFate> fates;
    for (std::size_t i = 0; i < kFates; ++i)
    {
        fates.push_back(sut.next(condition, must_arrive));
    }
    return fates;
}

bool is_same(const FrameFate& a, const FrameFate& b)
{
    return a.copies == b.copies && a.delays == b.delays;
}

std::size_t with_copies(const std::vector<FrameFate>& fates, std::size_t copies)
{
    return static_cast<std::size_t>(std::ranges::count(fates, copies, &FrameFate::copies));
}

/// Within five standard deviations of what a share of so many frames should give.
void expect_share(std::size_t found, double share, std::size_t frames)
{
    const double wanted = share * static_cast<double>(frames);
    EXPECT_NEAR(static_cast<double>(found), wanted, 5.0 * std::sqrt(wanted * (1.0 - share)));
}

TEST(FrameFates, a_link_without_faults_hands_over_each_frame_once_and_at_once)
{
    for (const FrameFate& fate : fates_of(1, {}))
    {
        ASSERT_EQ(fate.copies, 1U);
        ASSERT_EQ(fate.delays[0], Duration{});
    }
}

TEST(FrameFates, the_same_seed_gives_the_same_fates_and_another_one_others)
{
    const std::uint64_t seed = test::Random(1).bits();
    const LinkCondition condition{
        .delay_ms = 1.0, .jitter_ms = 2.0, .loss = 0.3, .duplicates = 0.3};
    const auto fates = fates_of(seed, condition);
    EXPECT_TRUE(std::ranges::equal(fates, fates_of(seed, condition), is_same));
    const auto others = fates_of(seed + 1, condition);
    std::size_t lost_in_both = 0;
    for (std::size_t i = 0; i < kFates; ++i)
    {
        lost_in_both += fates[i].copies == 0 && others[i].copies == 0 ? 1U : 0U;
    }
    expect_share(lost_in_both, 0.09, kFates);
}

TEST(FrameFates, shares_are_those_asked_for)
{
    const std::uint64_t seed = test::Random(2).bits();
    for (const double share : {0.001, 0.01, 0.5, 0.99})
    {
        const auto fates = fates_of(seed, {.loss = share, .duplicates = share});
        const std::size_t lost = with_copies(fates, 0);
        expect_share(lost, share, kFates);
        expect_share(with_copies(fates, 2), share, kFates - lost);
    }
}

TEST(FrameFates, a_share_of_nothing_takes_none_and_one_of_all_takes_each)
{
    EXPECT_EQ(with_copies(fates_of(3, {.loss = 1.0, .duplicates = 1.0}), 0), kFates);
    EXPECT_EQ(with_copies(fates_of(3, {.loss = 0.0, .duplicates = 1.0}), 2), kFates);
    EXPECT_EQ(with_copies(fates_of(3, {.loss = 0.0, .duplicates = 0.0}), 1), kFates);
}

TEST(FrameFates, losses_do_not_cluster)
{
    const auto fates = fates_of(test::Random(3).bits(), {.loss = 0.1});
    std::size_t pairs = 0;
    for (std::size_t i = 1; i < kFates; ++i)
    {
        pairs += fates[i - 1].copies == 0 && fates[i].copies == 0 ? 1U : 0U;
    }
    expect_share(pairs, 0.01, kFates - 1);
}

TEST(FrameFates, delays_fill_their_range_and_keep_to_it)
{
    const auto fates =
        fates_of(test::Random(4).bits(), {.delay_ms = 3.0, .jitter_ms = 2.0, .duplicates = 1.0});
    std::vector<Duration> delays;
    for (const FrameFate& fate : fates)
    {
        ASSERT_EQ(fate.copies, 2U);
        ASSERT_NE(fate.delays[0], fate.delays[1]);
        delays.insert(delays.end(), fate.delays.begin(), fate.delays.end());
    }
    const auto [least, most] = std::ranges::minmax(delays);
    EXPECT_GE(least, milliseconds(3));
    EXPECT_LT(least, microseconds(3'001));
    EXPECT_LE(most, milliseconds(5));
    EXPECT_GT(most, microseconds(4'999));
    const auto early =
        std::ranges::count_if(delays, [](Duration delay) { return delay < microseconds(3'500); });
    expect_share(static_cast<std::size_t>(early), 0.25, delays.size());
}

TEST(FrameFates, what_must_arrive_is_delayed_and_nothing_else)
{
    for (const FrameFate& fate :
         fates_of(5, {.delay_ms = 3.0, .loss = 1.0, .duplicates = 1.0}, true))
    {
        ASSERT_EQ(fate.copies, 1U);
        ASSERT_EQ(fate.delays[0], milliseconds(3));
    }
}

TEST(FrameFates, a_frame_keeps_its_fate_whatever_became_of_others)
{
    const LinkCondition condition{.jitter_ms = 2.0, .loss = 0.1, .duplicates = 0.1};
    const auto fates = fates_of(6, condition);
    FrameFates sut(6);
    for (std::size_t i = 0; i < kFates; ++i)
    {
        const bool is_other = i % 3 != 0;
        const FrameFate fate =
            sut.next(is_other ? LinkCondition{.loss = 0.9} : condition, is_other && i % 2 == 0);
        ASSERT_TRUE(is_other || is_same(fate, fates[i])) << "frame " << i;
    }
}

TEST(FrameFates, a_larger_loss_takes_the_frames_of_the_smaller_one_too)
{
    const auto few = fates_of(7, {.loss = 0.1});
    const auto many = fates_of(7, {.loss = 0.2});
    for (std::size_t i = 0; i < kFates; ++i)
    {
        ASSERT_TRUE(few[i].copies != 0 || many[i].copies == 0) << "frame " << i;
    }
}

} // namespace

} // namespace tactus::relay
