// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "transport/base/print_assertions.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace tactus::test
{

TEST(PrintAssertionsDeathTest, says_what_failed_and_where_before_the_process_stops)
{
    EXPECT_DEATH(
        {
            print_failed_assertions();
            TACTUS_ASSERT(1 + 1 == 3);
        },
        "assertion failed: 1 \\+ 1 == 3 \\(.*test_print_assertions.cpp:[0-9]+\\)");
}

TEST(PrintAssertionsDeathTest, leaves_a_program_its_own_handler)
{
    EXPECT_EXIT(
        {
            set_assert_handler([](const char*, const char*, int) noexcept { std::_Exit(7); });
            print_failed_assertions();
            TACTUS_ASSERT(false);
        },
        testing::ExitedWithCode(7), "^$");
}

} // namespace tactus::test
