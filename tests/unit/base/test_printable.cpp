// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/base/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus
{

namespace
{

TEST(Printable, keeps_printable_ascii_and_shows_every_other_byte_as_a_question_mark)
{
    for (int code = 0; code < 256; ++code)
    {
        const char c = static_cast<char>(code);
        const bool stays = code >= 0x20 && code < 0x7F;
        EXPECT_EQ(is_printable(c), stays) << code;
        EXPECT_EQ(printable(std::string(1, c)), std::string(1, stays ? c : '?')) << code;
    }
    EXPECT_EQ(printable("a\x1b[2J\nb\xff"), "a?[2J?b?");
    EXPECT_EQ(printable(""), "");
}

TEST(Printable, cuts_a_word_that_is_too_long_and_says_so)
{
    EXPECT_EQ(printable("abcd", 4), "abcd");
    EXPECT_EQ(printable("abcde", 4), "abcd...");
    EXPECT_EQ(printable("abcde\n", 4), "abcd...");
    const std::string name(63, 'a');
    EXPECT_EQ(printable(name), name);
    EXPECT_EQ(printable(name + "b"), name + "...");
}

TEST(Printable, shows_the_control_characters_of_a_line_as_question_marks_and_keeps_the_rest)
{
    for (int code = 0; code < 256; ++code)
    {
        const char c = static_cast<char>(code);
        const bool stays = code >= 0x20 && code != 0x7F;
        EXPECT_EQ(printable_line(std::string(1, c)), std::string(1, stays ? c : '?')) << code;
    }
    const std::string long_line(1'000, 'a');
    EXPECT_EQ(printable_line("\xc2\x9b" // A terminal takes it for ESC [.
                             "2J\xc2\xa0\xc3\x9f\xc2"),
              "?2J\xc2\xa0\xc3\x9f\xc2");
    EXPECT_EQ(printable_line(long_line + "\n\xc3\xbc.stl"), long_line + "?\xc3\xbc.stl");
}

} // namespace

} // namespace tactus
