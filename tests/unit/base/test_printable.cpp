// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus
{

namespace
{

TEST(Printable, keeps_letters_and_shows_what_is_none_or_steers_as_a_question_mark)
{
    for (int code = 0; code < 256; ++code)
    {
        const char c = static_cast<char>(code);
        const bool stays = code >= 0x20 && code < 0x7F;
        EXPECT_EQ(is_printable(c), stays) << code;
        EXPECT_EQ(printable(std::string(1, c)), std::string(1, stays ? c : '?')) << code;
    }
    EXPECT_EQ(printable("a\x1b[2J\nb\xff"), "a?[2J?b?");
    EXPECT_EQ(printable("W\u00FCrfel\u202E"), "W\u00FCrfel?");
    EXPECT_EQ(printable(""), "");
}

TEST(Printable, cuts_a_word_that_is_too_long_and_says_so)
{
    EXPECT_EQ(printable("abcd", 4), "abcd");
    EXPECT_EQ(printable("abcde", 4), "abcd...");
    EXPECT_EQ(printable("abcde\n", 4), "abcd...");
    EXPECT_EQ(printable("abc\u00FC", 4), "abc...");
    EXPECT_EQ(printable("ab\u00FC", 4), "ab\u00FC");
    const std::string name(63, 'a');
    EXPECT_EQ(printable(name), name);
    EXPECT_EQ(printable(name + "b"), name + "...");
}

TEST(Printable, keeps_the_utf_8_of_a_line_and_shows_what_steers_a_terminal_as_question_marks)
{
    for (int code = 0; code < 256; ++code)
    {
        const char c = static_cast<char>(code);
        const bool stays = code >= 0x20 && code < 0x7F; // Bytes above are parts of a character.
        EXPECT_EQ(printable_line(std::string(1, c)), std::string(1, stays ? c : '?')) << code;
    }
    const std::string long_line(1'000, 'a');
    EXPECT_EQ(printable_line("\xc2\x9b" // Terminals interpret it as ESC [.
                             "2J\xc2\xa0\xc3\x9f\xc2"),
              "?2J\xc2\xa0\xc3\x9f?");
    EXPECT_EQ(printable_line("\x9b\x32J"), "?2J") << "ESC [ of a terminal with 8 bits";
    for (const char* steering : {"\u0080", "\u0085", "\u009F", "\u061C", "\u200E", "\u200F",
                                 "\u2028", "\u2029", "\u202A", "\u202E", "\u2066", "\u2069"})
    {
        EXPECT_EQ(printable_line(std::string("a") + steering + "b"), "a?b") << steering;
    }
    for (const char* seen : {"\u00A0", "\u00FF", "\u061B", "\u200D", "\u2010", "\u2030", "\u2065",
                             "\u206A", "\u65E5", "\U0001F600", "\U0010FFFF"})
    {
        EXPECT_EQ(printable_line(seen), seen);
    }
    EXPECT_EQ(printable_line(long_line + "\n\xc3\xbc.stl"), long_line + "?\xc3\xbc.stl");
}

} // namespace

} // namespace tactus
