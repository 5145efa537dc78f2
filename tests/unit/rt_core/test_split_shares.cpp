// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/split_shares.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr double kSlow = Priority::kLeastSpeed_m_per_s;

TEST(Priority, goes_by_the_time_until_contact_at_the_hands_speed)
{
    EXPECT_EQ(Priority::at(0.0, 0.0, false).of, PriorityClass::touching);
    EXPECT_EQ(Priority::at(0.001, 1.0, false).of, PriorityClass::touching);
    EXPECT_EQ(Priority::at(0.0011, 1.0, false).of, PriorityClass::soon);
    EXPECT_EQ(Priority::at(0.05, 1.0, false).of, PriorityClass::soon);
    EXPECT_EQ(Priority::at(0.051, 1.0, false).of, PriorityClass::later);
    EXPECT_DOUBLE_EQ(Priority::at(0.5, 2.0, false).contact_s, 0.25);
}

TEST(Priority, counts_a_hand_at_rest_as_one_that_may_move)
{
    EXPECT_DOUBLE_EQ(Priority::at(kSlow, 0.0, false).contact_s, 1.0);
    EXPECT_EQ(Priority::at(0.0009 * kSlow, 0.0, false).of, PriorityClass::touching);
}

TEST(Priority, lets_tools_without_a_force_come_a_class_later)
{
    EXPECT_EQ(Priority::at(0.0, 0.0, true).of, PriorityClass::soon);
    EXPECT_EQ(Priority::at(1.0, 0.0, true).of, PriorityClass::last);
}

TEST(Priority, orders_by_class_and_then_by_time)
{
    const Priority passing = Priority::at(0.0, 1.0, true);
    const Priority sooner = Priority::at(0.01, 1.0, false);
    const Priority touching = Priority::at(0.0, 1.0, false);
    EXPECT_LT(touching, sooner);
    EXPECT_LT(Priority::at(0.01, 1.0, false), Priority::at(0.02, 1.0, false));
    EXPECT_LT(sooner, passing) << "of the same class, and not there yet";
    EXPECT_FALSE(passing < sooner);
    EXPECT_LT(passing, Priority::at(0.01, 1.0, true));
    EXPECT_FALSE(touching < touching);
}

/// One frame in which every request takes its whole share, or nothing.
struct SharedFrame
{
    std::uint32_t splits{0};
    std::uint32_t saved{0};
    std::array<std::vector<bool>, kPriorityClasses> takes; ///< Takers by class and request.
    std::array<std::vector<std::uint32_t>, kPriorityClasses> got;

    std::uint32_t run()
    {
        SplitShares sut(splits);
        for (std::size_t of = 0; of < kPriorityClasses; ++of)
        {
            for (std::size_t i = 0; i < takes[of].size(); ++i)
            {
                sut.add(static_cast<PriorityClass>(of));
            }
        }
        std::uint32_t done = 0;
        for (std::size_t of = 0; of < kPriorityClasses; ++of)
        {
            got[of].clear();
            for (const bool takes_all : takes[of])
            {
                const auto share = sut.take(static_cast<PriorityClass>(of), saved, done);
                EXPECT_GE(share.limit, done + share.equal);
                got[of].push_back(share.equal);
                done = takes_all ? share.limit : done;
            }
        }
        return done;
    }
};

TEST(SplitShares, one_request_may_take_all)
{
    for (const std::uint32_t splits : {0U, 1U, 7U, 64U, 256U})
    {
        SharedFrame frame;
        frame.splits = splits;
        frame.takes[2] = {true};
        EXPECT_EQ(frame.run(), splits);
    }
}

TEST(SplitShares, equals_of_a_class_get_equal_parts_and_what_one_leaves_goes_on)
{
    SharedFrame frame;
    frame.splits = 64;
    frame.takes[0] = {true, true, true, true};
    EXPECT_EQ(frame.run(), 64U);
    EXPECT_EQ(frame.got[0], (std::vector<std::uint32_t>{16, 16, 16, 16}));
    frame.takes[0] = {false, false, true, true};
    frame.run();
    EXPECT_EQ(frame.got[0], (std::vector<std::uint32_t>{16, 22, 32, 32}));
}

TEST(SplitShares, keeps_an_eighth_for_each_class_below_in_which_somebody_waits)
{
    SharedFrame frame;
    frame.splits = 64;
    frame.takes[0] = {true};
    frame.takes[3] = {true};
    frame.run();
    EXPECT_EQ(frame.got[0][0], 56U);
    EXPECT_EQ(frame.got[3][0], 8U);
    frame.takes[1] = {true};
    frame.takes[2] = {true};
    frame.run();
    EXPECT_EQ(frame.got[0][0], 40U);
    for (std::size_t of = 1; of < kPriorityClasses; ++of)
    {
        EXPECT_EQ(frame.got[of][0], 8U) << of;
    }
}

TEST(SplitShares, what_was_saved_comes_on_top_but_leaves_one_for_each_other)
{
    SplitShares sut(16);
    for (int i = 0; i < 4; ++i)
    {
        sut.add(PriorityClass::touching);
    }
    const auto first = sut.take(PriorityClass::touching, 6, 0);
    EXPECT_EQ(first.equal, 4U);
    EXPECT_EQ(first.limit, 10U);
    EXPECT_EQ(sut.take(PriorityClass::touching, 100, 10).limit, 14U) << "two others wait";
}

TEST(SplitShares, what_is_left_is_saved_and_what_is_used_beyond_is_paid)
{
    const SplitShares sut(64);
    EXPECT_EQ(sut.save(0, 16, 5), 11U);
    EXPECT_EQ(sut.save(11, 16, 20), 7U);
    EXPECT_EQ(sut.save(11, 16, 64), 0U);
    EXPECT_EQ(sut.save(30, 16, 0), 32U) << "half of a frame's at most";
    EXPECT_EQ(sut.save_all(0), 8U);
}

/// Shares never exceed the total, and every waiting class gets its eighth if there are at least
/// eight splits, one split for each of its first requests if it has more.
TEST(SplitShares, no_class_is_starved_and_no_budget_overdrawn)
{
    const std::uint64_t seed = seed_of(2'300);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    for (int round = 0; round < 2'000; ++round)
    {
        SharedFrame frame;
        frame.splits = 8 + random.below(249);
        frame.saved = random.below(frame.splits);
        for (auto& takes : frame.takes)
        {
            takes.resize(random.below(65));
            for (std::size_t i = 0; i < takes.size(); ++i)
            {
                takes[i] = random.below(4) > 0;
            }
        }
        ASSERT_LE(frame.run(), frame.splits);
        const std::uint32_t eighth = (frame.splits + 7) / 8;
        for (std::size_t of = 0; of < kPriorityClasses; ++of)
        {
            std::uint32_t served = 0;
            for (const std::uint32_t got : frame.got[of])
            {
                served += got > 0 ? 1U : 0U;
            }
            ASSERT_GE(served, std::min<std::size_t>(eighth, frame.takes[of].size()))
                << "class " << of << ", " << frame.splits << " splits";
        }
    }
}

struct WaitingRequest
{
    PriorityClass of;
    std::uint32_t saved{0};
    std::uint32_t waited{0};
    std::uint32_t longest{0};

    /// Order of service; the least is first.
    [[nodiscard]] auto turn() const { return std::tuple(of, ~waited, ~saved); }
};

/// Requests that all wait, frame after frame, each in its class. Those that got nothing for the
/// longest time are first, then those with most savings, like Refinement; or always the first ones.
class WaitingRequests
{
public:
    WaitingRequests(std::uint32_t splits, Random random) : splits_(splits), random_(random) {}

    void add(PriorityClass of) { requests_.push_back({of}); }
    [[nodiscard]] std::uint32_t count(PriorityClass of) const
    {
        return static_cast<std::uint32_t>(std::ranges::count(requests_, of, &WaitingRequest::of));
    }
    /// Longest sequence of frames that left nothing for one request of a class.
    [[nodiscard]] std::uint32_t longest_wait(PriorityClass of) const
    {
        std::uint32_t longest = 0;
        for (const WaitingRequest& request : requests_)
        {
            longest = request.of == of ? std::max(longest, request.longest) : longest;
        }
        return longest;
    }

    void run_frame(bool by_waiting)
    {
        if (by_waiting)
        {
            std::ranges::stable_sort(requests_, [](const WaitingRequest& a, const WaitingRequest& b)
                                     { return a.turn() < b.turn(); });
        }
        SplitShares sut(splits_);
        for (const WaitingRequest& request : requests_)
        {
            sut.add(request.of);
        }
        std::uint32_t done = 0;
        for (WaitingRequest& request : requests_)
        {
            const auto share = sut.take(request.of, request.saved, done);
            const std::uint32_t most = share.limit - done;
            // Most requests take their whole share.
            const std::uint32_t used = random_.one_in(4) ? random_.below(most + 1) : most;
            request.saved = sut.save(request.saved, share.equal, used);
            request.waited = share.equal == 0 ? request.waited + 1 : 0;
            request.longest = std::max(request.longest, request.waited);
            done += used;
        }
        ASSERT_LE(done, splits_);
    }

private:
    std::uint32_t splits_;
    Random random_;
    std::vector<WaitingRequest> requests_; ///< Classes in order.
};

std::uint32_t share_up(std::uint32_t count, std::uint32_t parts)
{
    return (count + parts - 1) / parts;
}

/// Stated bound: each of n requests of a class may take one in ceil(n / ceil(K / 8)) frames.
TEST(SplitShares, each_of_64_waiting_requests_has_its_turn_within_the_stated_number_of_frames)
{
    const std::uint64_t seed = seed_of(2'301);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    for (const std::uint32_t splits : {8U, 9U, 16U, 20U, 64U, 100U, 256U})
    {
        constexpr std::uint32_t classes = kPriorityClasses;
        for (std::uint32_t mix = 0; mix < 2 * classes; ++mix) // First all in one class.
        {
            WaitingRequests requests(splits, random);
            for (int i = 0; i < 64; ++i)
            {
                requests.add(
                    static_cast<PriorityClass>(mix < classes ? mix : random.below(classes)));
            }
            for (int frame = 0; frame < 2'000; ++frame)
            {
                ASSERT_NO_FATAL_FAILURE(requests.run_frame(true));
            }
            for (std::uint32_t i = 0; i < kPriorityClasses; ++i)
            {
                const auto of = static_cast<PriorityClass>(i);
                const std::uint32_t count = requests.count(of);
                ASSERT_LT(requests.longest_wait(of),
                          std::max(1U, share_up(count, share_up(splits, 8))))
                    << splits << " splits, " << count << " of class " << i;
            }
        }
    }
}

/// The last ones never get a split without that order, on which the bound depends.
TEST(SplitShares, leave_nothing_for_the_last_of_64_whose_turn_never_changes)
{
    WaitingRequests requests(16, Random::seeded(1));
    for (int i = 0; i < 64; ++i)
    {
        requests.add(PriorityClass::soon);
    }
    for (int frame = 0; frame < 100; ++frame)
    {
        ASSERT_NO_FATAL_FAILURE(requests.run_frame(false));
    }
    EXPECT_EQ(requests.longest_wait(PriorityClass::soon), 100U);
}

} // namespace
} // namespace tactus::test
