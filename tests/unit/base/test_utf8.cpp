// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/utf8.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus
{

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
