// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// That a page is well-formed is looked at by an XML parser, in integration.hrtc_bad_input; here,
/// that no text can make it otherwise.

#include "platform/plot/bar_plot.hpp"
#include "platform/plot/markup.hpp"
#include "platform/plot/page.hpp"
#include "tests/shared/count_of.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus::plot::test
{

namespace
{

using tactus::test::count_of;

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

TEST(Shortened, cuts_between_characters)
{
    EXPECT_EQ(shortened("abcd", 4), "abcd");
    EXPECT_EQ(shortened("abcde", 4), "abc\u2026");
    EXPECT_EQ(shortened("\u00E4\u00F6\u00FC\u00DF", 3), "\u00E4\u00F6\u2026");
    EXPECT_EQ(characters_of("\u00E4b\u20AC"), 3U);
}

Page full_page(const std::string& text)
{
    Page page(text);
    page.verdict(text, false);
    page.heading(text);
    page.paragraph(text);
    page.table({{{text, false}, {text}}, {{text, text}, {text}}});
    page.tables({{text, facts({{text, text}})}});
    page.drawings({draw(BarPlot{text, text, {{text, {{text, 1.0}}}}})});
    return page;
}

TEST(Page, escapes_whatever_is_in_it)
{
    const std::string html = full_page("</td>\"<script>").html();
    EXPECT_EQ(html.find("<script>"), std::string::npos);
    EXPECT_EQ(count_of(html, "</td>"), count_of(html, "<td"));
    EXPECT_EQ(count_of(html, "&lt;/td&gt;&quot;&lt;script&gt;"), 18U); // Each text that it takes.
}

TEST(Page, needs_nothing_from_elsewhere)
{
    const std::string html = full_page("text").html();
    for (const char* way : {"<script", "<link", "<img", "@import", "url(", "href", " src="})
    {
        EXPECT_EQ(html.find(way), std::string::npos) << way;
    }
    std::size_t addresses = count_of(html, "http");
    addresses -= count_of(html, "\"http://www.w3.org/1999/xhtml\"");
    addresses -= count_of(html, "\"http://www.w3.org/2000/svg\"");
    EXPECT_EQ(addresses, 0U); // What is left are names of languages.
}

} // namespace

} // namespace tactus::plot::test
