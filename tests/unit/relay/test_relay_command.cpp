// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/relay_command.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace tactus::relay
{

namespace
{

TEST(RelayCommand, words_are_read)
{
    EXPECT_TRUE(std::holds_alternative<Cut>(parse_command("cut").value()));
    EXPECT_TRUE(std::holds_alternative<Mend>(parse_command("mend").value()));
    EXPECT_TRUE(std::holds_alternative<Count>(parse_command("count").value()));
}

TEST(RelayCommand, each_figure_can_be_set_to_both_ends_of_its_range)
{
    struct Case
    {
        std::string_view line;
        double LinkCondition::*figure;
        double value;
    };
    for (const Case& wanted : {Case{"set delay-ms 0", &LinkCondition::delay_ms, 0.0},
                               Case{"set delay-ms 10000", &LinkCondition::delay_ms, 10'000.0},
                               Case{"set jitter-ms 0.5", &LinkCondition::jitter_ms, 0.5},
                               Case{"set loss 0.01", &LinkCondition::loss, 0.01},
                               Case{"set loss 1", &LinkCondition::loss, 1.0},
                               Case{"set duplicates 1e-3", &LinkCondition::duplicates, 1e-3}})
    {
        SCOPED_TRACE(wanted.line);
        const Set sut = std::get<Set>(parse_command(wanted.line).value());
        EXPECT_EQ(sut.figure, wanted.figure);
        EXPECT_EQ(sut.value, wanted.value);
    }
}

TEST(RelayCommand, everything_else_is_refused)
{
    for (const std::string_view line : {"",
                                        " ",
                                        "cut ",
                                        "Cut",
                                        "cut mend",
                                        "set",
                                        "set ",
                                        "set loss",
                                        "set loss ",
                                        "set loss x",
                                        "set loss 0.1x",
                                        "set loss  0.1",
                                        "set loss -0.1",
                                        "set loss 1.01",
                                        "set loss nan",
                                        "set loss inf",
                                        "set duplicates 2",
                                        "set delay-ms 10001",
                                        "set jitter-ms -1",
                                        "set speed 1",
                                        "set  1",
                                        "count\r"})
    {
        EXPECT_FALSE(parse_command(line)) << '\'' << line << '\'';
    }
}

TEST(RelayCommand, what_is_allowed_names_all_that_is_read)
{
    const std::string sut = command_forms();
    for (const std::string_view form :
         {"cut", "mend", "count", "set delay-ms 0..10000", "set jitter-ms 0..10000",
          "set loss 0..1", "set duplicates 0..1"})
    {
        EXPECT_NE(sut.find(form), std::string::npos) << form;
    }
}

} // namespace

} // namespace tactus::relay
