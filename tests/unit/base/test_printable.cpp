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

namespace
{

TEST(Utf8, characters_have_their_bytes_and_what_is_none_has_0)
{
    EXPECT_EQ(character_bytes(""), 0U);
    EXPECT_EQ(character_bytes("ab"), 1U);
    EXPECT_EQ(character_bytes("\u00FCb"), 2U);
    EXPECT_EQ(character_bytes("\u65E5"), 3U);
    EXPECT_EQ(character_bytes("\U0001F600"), 4U);
    for (const char* none : {"\x80", "\xC0\x80", "\xC3", "\xC3g", "\xE0\x80\x80", "\xED\xA0\x80",
                             "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"})
    {
        EXPECT_EQ(character_bytes(none), 0U);
    }
}

TEST(Utf8, a_text_is_cut_between_characters)
{
    const std::string text = "a\u00FC\u65E5\U0001F600z";
    const std::size_t whole[] = {0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10, 11, 11};
    for (std::size_t longest = 0; longest < std::size(whole); ++longest)
    {
        EXPECT_EQ(whole_characters(text, longest), text.substr(0, whole[longest])) << longest;
    }
    EXPECT_EQ(whole_characters("\xFF\xFF\xFF\xFF", 2), "\xFF\xFF");
}

TEST(Utf8, letters_are_told_from_blanks_signs_and_what_is_not_seen)
{
    for (const char* letter : {"\u00FC", "\u00AA", "\u00B5", "\u00DF", "\u03B1", "\u0416", "\u0308",
                               "\u05D0", "\u0E01", "\u3042", "\u65E5", "\uAC00", "\U00020000"})
    {
        EXPECT_TRUE(is_letter(letter)) << letter;
    }
    for (const char* other :
         {"",       "a",      "ab",     "\xC3",   "\u00FC\u00FC", "\u0085",    "\u00A0", "\u00AD",
          "\u00AB", "\u00BB", "\u061C", "\u2003", "\u200B",       "\u2013",    "\u202E", "\u2066",
          "\u3000", "\uE000", "\uFEFF", "\uFFFD", "\U000E0001",   "\U0010FFFF"})
    {
        EXPECT_FALSE(is_letter(other)) << other;
    }
}

} // namespace

} // namespace tactus
