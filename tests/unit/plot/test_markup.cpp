// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/markup.hpp"
#include "tests/shared/markup_reader.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace tactus::plot::test
{

namespace
{

TEST(Escaped, leaves_nothing_that_markup_has_a_meaning_for)
{
    EXPECT_EQ(escaped("a<b & c>d \"e\" 'f'"), "a&lt;b &amp; c&gt;d &quot;e&quot; &#39;f&#39;");
    EXPECT_EQ(escaped("\u00E4 \u20AC \U0001F600"), "\u00E4 \u20AC \U0001F600");
    EXPECT_EQ(escaped(""), "");
}

TEST(Escaped, replaces_what_is_no_character)
{
    EXPECT_EQ(escaped(std::string("a\0b", 3)), "a\uFFFDb");
    EXPECT_EQ(escaped("\x1B[31m\x7F"), "\uFFFD[31m\uFFFD");
    EXPECT_EQ(escaped("\xFFz"), "\uFFFDz");
    EXPECT_EQ(escaped("\xC3"), "\uFFFD");           // Cut off.
    EXPECT_EQ(escaped("\xC0\xAF"), "\uFFFD\uFFFD"); // Too long a form.
    EXPECT_EQ(escaped("\xE0\x80\xBC"), "\uFFFD\uFFFD\uFFFD");
    EXPECT_EQ(escaped("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD"); // Half of a pair of UTF-16.
    EXPECT_EQ(escaped("\xEF\xBF\xBF"), "\uFFFD\uFFFD\uFFFD");
    EXPECT_EQ(escaped("\xC2\x85"), "\uFFFD\uFFFD"); // A control character beyond ASCII.
    EXPECT_EQ(escaped("\t\n\r"), "\t\n\uFFFD");
}

TEST(Escaped, any_bytes_make_text)
{
    constexpr unsigned kSeed = 71'122;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    for (int i = 0; i < 2'000; ++i)
    {
        std::string bytes(random() % 24, ' ');
        for (char& byte : bytes)
        {
            byte = static_cast<char>(random() & 0xFFU);
        }
        const std::string page = "<p title=\"" + escaped(bytes) + "\">" + escaped(bytes) + "</p>";
        ASSERT_TRUE(tactus::test::read_markup(page).has_value()) << page;
        ASSERT_EQ(escaped(bytes).find('\x1B'), std::string::npos);
    }
}

TEST(Shortened, cuts_between_characters)
{
    EXPECT_EQ(shortened("abcd", 4), "abcd");
    EXPECT_EQ(shortened("abcde", 4), "abc\u2026");
    EXPECT_EQ(shortened("\u00E4\u00F6\u00FC\u00DF", 3), "\u00E4\u00F6\u2026");
    EXPECT_EQ(shortened("ab", 1), "\u2026");
    EXPECT_EQ(shortened("", 1), "");
    EXPECT_EQ(characters_of("\u00E4b\u20AC"), 3U);
}

TEST(MarkupReader, refuses_what_is_not_well_formed)
{
    for (const char* bad : {"", "text", "<p>", "</p>", "<p></q>", "<p><q></p></q>", "<p>&</p>",
                            "<p>a<b</p>", "<p a=1></p>", "<p a=\"1\" a=\"2\"></p>", "<p></p>text",
                            "<p>\x01</p>", "<p/><p/>", "<p>&nbsp;</p>"})
    {
        EXPECT_FALSE(tactus::test::read_markup(bad).has_value()) << bad;
    }
    const auto good = tactus::test::read_markup("<p a=\"1\">x &amp; y<br/></p>\n");
    ASSERT_TRUE(good.has_value());
    EXPECT_TRUE(good->has_text("x & y"));
    EXPECT_EQ(good->count("br"), 1U);
}

} // namespace

} // namespace tactus::plot::test
