// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/checked.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

/// Known results of the memory model in tiny programs: the explorer finds all allowed outcomes and
/// no others.
namespace tactus::interleave
{
namespace
{

constexpr auto kRelaxed = std::memory_order_relaxed;
constexpr auto kAcquire = std::memory_order_acquire;
constexpr auto kRelease = std::memory_order_release;

/// Two locations, a plain variable, and the values read; each element by one thread.
struct Shared
{
    CheckedAtomic<std::uint32_t> x;
    CheckedAtomic<std::uint32_t> y;
    CheckedSlot<int> plain;
    std::array<std::uint32_t, 4> read{};
};
using Bodies = std::vector<SmallProgram<Shared>::Body>;

/// Explores and collects the first `count` reads as digits.
std::set<std::string> outcomes(const Bodies& bodies, std::size_t count)
{
    std::set<std::string> seen;
    const Exploration result =
        explore_small<Shared>(bodies,
                              [&](Shared& shared)
                              {
                                  std::string digits;
                                  for (std::size_t i = 0; i < count; ++i)
                                  {
                                      digits += static_cast<char>('0' + shared.read.at(i));
                                  }
                                  seen.insert(digits);
                              });
    EXPECT_EQ(result.failure, "");
    return seen;
}

Bodies message_passing(std::memory_order store, std::memory_order load)
{
    return {[=](Shared& s)
            {
                s.x.store(1, kRelaxed);
                s.y.store(1, store);
            },
            [=](Shared& s)
            {
                s.read[0] = s.y.load(load);
                s.read[1] = s.x.load(kRelaxed);
            }};
}

using Outcomes = std::set<std::string>;

TEST(Explorer, a_message_passed_by_release_and_acquire_is_never_stale)
{
    EXPECT_EQ(outcomes(message_passing(kRelease, kAcquire), 2), (Outcomes{"00", "01", "11"}));
}

TEST(Explorer, a_message_passed_with_either_side_relaxed_may_be_stale)
{
    const Outcomes all{"00", "01", "10", "11"};
    EXPECT_EQ(outcomes(message_passing(kRelaxed, kAcquire), 2), all);
    EXPECT_EQ(outcomes(message_passing(kRelease, kRelaxed), 2), all);
    EXPECT_EQ(outcomes(message_passing(kRelaxed, kRelaxed), 2), all);
}

TEST(Explorer, stores_are_buffered_under_release_and_acquire)
{
    const Bodies bodies{[](Shared& s)
                        {
                            s.x.store(1, kRelease);
                            s.read[0] = s.y.load(kAcquire);
                        },
                        [](Shared& s)
                        {
                            s.y.store(1, kRelease);
                            s.read[1] = s.x.load(kAcquire);
                        }};
    EXPECT_EQ(outcomes(bodies, 2), (Outcomes{"00", "01", "10", "11"}));
}

TEST(Explorer, one_location_never_goes_back_even_relaxed)
{
    const Bodies bodies{[](Shared& s)
                        {
                            s.x.store(1, kRelaxed);
                            s.x.store(2, kRelaxed);
                        },
                        [](Shared& s)
                        {
                            s.read[0] = s.x.load(kRelaxed);
                            s.read[1] = s.x.load(kRelaxed);
                        }};
    EXPECT_EQ(outcomes(bodies, 2), (Outcomes{"00", "01", "02", "11", "12", "22"}));
}

/// The thread may learn of the later value from another one's read of it.
TEST(Explorer, what_one_thread_read_and_passed_on_is_not_older_for_the_next)
{
    const Bodies bodies{[](Shared& s) { s.x.store(1, kRelaxed); },
                        [](Shared& s)
                        {
                            s.read[0] = s.x.load(kRelaxed);
                            s.y.store(1, kRelease);
                        },
                        [](Shared& s)
                        {
                            s.read[1] = s.y.load(kAcquire);
                            s.read[2] = s.x.load(kRelaxed);
                        }};
    const Outcomes seen = outcomes(bodies, 3);
    EXPECT_TRUE(seen.contains("111"));
    EXPECT_FALSE(seen.contains("110"));
    EXPECT_EQ(seen.size(), 7U);
}

/// A store that follows a release on its thread continues no release sequence, since C++20.
TEST(Explorer, a_relaxed_store_after_a_release_publishes_nothing)
{
    const Bodies bodies{[](Shared& s)
                        {
                            s.x.store(1, kRelaxed);
                            s.y.store(1, kRelease);
                            s.y.store(2, kRelaxed);
                        },
                        [](Shared& s)
                        {
                            s.read[0] = s.y.load(kAcquire);
                            s.read[1] = s.x.load(kRelaxed);
                        }};
    EXPECT_EQ(outcomes(bodies, 2), (Outcomes{"00", "01", "11", "20", "21"}));
}

TEST(Explorer, two_readers_may_disagree_on_the_order_of_two_writers)
{
    const Bodies bodies{[](Shared& s) { s.x.store(1, kRelease); },
                        [](Shared& s) { s.y.store(1, kRelease); },
                        [](Shared& s)
                        {
                            s.read[0] = s.x.load(kAcquire);
                            s.read[1] = s.y.load(kAcquire);
                        },
                        [](Shared& s)
                        {
                            s.read[2] = s.y.load(kAcquire);
                            s.read[3] = s.x.load(kAcquire);
                        }};
    const Outcomes seen = outcomes(bodies, 4);
    EXPECT_TRUE(seen.contains("1010"));
    EXPECT_EQ(seen.size(), 16U);
}

Bodies publish_a_plain_variable(std::memory_order store, std::memory_order load)
{
    return {[=](Shared& s)
            {
                s.plain = 7;
                s.y.store(1, store);
            },
            [=](Shared& s)
            {
                if (s.y.load(load) == 1)
                {
                    require(s.plain == 7, "a stale plain variable");
                }
            }};
}

TEST(Explorer, a_plain_variable_published_by_release_and_acquire_has_no_race)
{
    EXPECT_EQ(explore_small<Shared>(publish_a_plain_variable(kRelease, kAcquire)).failure, "");
}

TEST(Explorer, finds_the_race_when_either_side_is_relaxed_and_tells_the_schedule)
{
    EXPECT_EQ(explore_small<Shared>(publish_a_plain_variable(kRelaxed, kAcquire)).failure,
              "race: thread 1 reads what thread 0 wrote; after\n"
              "  thread 0: store 1 = 1 (relaxed)\n"
              "  thread 1: load  1 -> 1 (acquire)\n");
    EXPECT_NE(explore_small<Shared>(publish_a_plain_variable(kRelease, kRelaxed)).failure, "");
}

TEST(Explorer, finds_a_write_after_an_unordered_read)
{
    const Bodies bodies{[](Shared& s)
                        {
                            static_cast<void>(static_cast<int>(s.plain));
                            s.y.store(1, kRelaxed);
                        },
                        [](Shared& s)
                        {
                            if (s.y.load(kAcquire) == 1)
                            {
                                s.plain = 1;
                            }
                        }};
    EXPECT_EQ(explore_small<Shared>(bodies).failure.substr(0, 44),
              "race: thread 1 writes what thread 0 reads; a");
}

TEST(Explorer, refuses_what_it_does_not_model)
{
    const auto write = [](Shared& s) { s.x.store(1, kRelaxed); };
    EXPECT_NE(explore_small<Shared>({write, write}).failure, "");
    EXPECT_NE(
        explore_small<Shared>({[](Shared& s) { s.x.store(1, std::memory_order_seq_cst); }}).failure,
        "");
}

TEST(Explorer, leaves_out_only_orders_of_what_commutes)
{
    const Bodies apart{[](Shared& s) { s.x.store(1, kRelaxed); },
                       [](Shared& s) { s.y.store(1, kRelaxed); }};
    const Exploration independent = explore_small<Shared>(apart);
    EXPECT_EQ(independent.executions, 1U);
    EXPECT_EQ(independent.redundant, 1U);

    // The load is before the store; or after it, with the old or new value.
    const Bodies together{[](Shared& s) { s.x.store(1, kRelaxed); },
                          [](Shared& s) { s.read[0] = s.x.load(kRelaxed); }};
    EXPECT_EQ(explore_small<Shared>(together).executions, 3U);

    // None, one or two stores precede the load, which then sees 1, 2 or 3 values.
    const Bodies twice{[](Shared& s)
                       {
                           s.x.store(1, kRelaxed);
                           s.x.store(2, kRelaxed);
                       },
                       [](Shared& s) { s.read[0] = s.x.load(kRelaxed); }};
    EXPECT_EQ(explore_small<Shared>(twice).executions, 6U);

    // Two loads, with stores before the first and the second: the first sees any of the former, the
    // second nothing older than that.
    const Bodies loads{twice[0], [](Shared& s)
                       {
                           s.read[0] = s.x.load(kRelaxed);
                           s.read[1] = s.x.load(kRelaxed);
                       }};
    std::uint64_t expected = 0;
    for (std::uint64_t before = 0; before <= 2; ++before)
    {
        for (std::uint64_t until = before; until <= 2; ++until)
        {
            for (std::uint64_t first = 0; first <= before; ++first)
            {
                expected += until - first + 1;
            }
        }
    }
    EXPECT_EQ(explore_small<Shared>(loads).executions, expected);
}

} // namespace
} // namespace tactus::interleave
