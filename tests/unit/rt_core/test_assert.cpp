// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "rt_core/base/result.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <string>

namespace tactus::test
{

namespace
{

void print_condition(const char* condition, const char* file, int line) noexcept
{
    static_cast<void>(std::fprintf(stderr, "told: %s in %s, %d\n", condition, file, line));
}

void ignore(const char* /*condition*/, const char* /*file*/, int /*line*/) noexcept {}

enum class Refusal
{
    too_big
};

} // namespace

TEST(AssertDeathTest, a_failed_assertion_stops_the_process)
{
    EXPECT_DEATH(TACTUS_ASSERT(1 + 1 == 3), "");
}

TEST(AssertDeathTest, the_handler_is_told_the_condition_and_place)
{
    EXPECT_DEATH(
        {
            set_assert_handler(print_condition);
            TACTUS_ASSERT(1 + 1 == 3);
        },
        "told: 1 \\+ 1 == 3 in .*test_assert.cpp, ");
}

TEST(AssertDeathTest, a_handler_that_returns_does_not_let_the_bug_go_on)
{
    EXPECT_DEATH(
        {
            set_assert_handler(ignore);
            TACTUS_ASSERT(false);
            std::fprintf(stderr, "went on\n");
            std::_Exit(0);
        },
        "");
}

TEST(Assert, a_true_condition_is_evaluated_once_and_passes)
{
    int evaluated = 0;

    TACTUS_ASSERT(++evaluated == 1);

    EXPECT_EQ(evaluated, 1);
}

TEST(Assert, setting_a_handler_returns_the_one_before)
{
    const AssertHandler first = set_assert_handler(ignore);

    EXPECT_EQ(set_assert_handler(print_condition), ignore);
    EXPECT_EQ(set_assert_handler(first), print_condition);
}

TEST(Result, holds_a_value_or_the_reason)
{
    const Result<int, Refusal> good(7);
    const Result<int, Refusal> bad(Refusal::too_big);

    EXPECT_TRUE(good.has_value());
    EXPECT_TRUE(static_cast<bool>(good));
    EXPECT_EQ(good.value(), 7);
    EXPECT_FALSE(bad.has_value());
    EXPECT_EQ(bad.error(), Refusal::too_big);
}

TEST(Result, hands_a_value_over_that_can_only_be_moved)
{
    Result<std::unique_ptr<std::string>, Refusal> sut(std::make_unique<std::string>("text"));

    sut.value()->append("ure");
    const std::unique_ptr<std::string> taken = std::move(sut).value();

    EXPECT_EQ(*taken, "texture");
}

TEST(ResultDeathTest, asking_for_what_is_not_there_is_a_bug)
{
    const Result<int, Refusal> good(7);
    const Result<int, Refusal> bad(Refusal::too_big);

    EXPECT_DEATH(static_cast<void>(good.error()), "");
    EXPECT_DEATH(static_cast<void>(bad.value()), "");
}

} // namespace tactus::test
