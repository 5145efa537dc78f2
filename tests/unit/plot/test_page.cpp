// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/line_plot.hpp"
#include "platform/plot/page.hpp"
#include "tests/shared/markup_reader.hpp"
#include "tests/unit/plot/drawing_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tactus::plot::test
{

namespace
{

constexpr const char* kHostile = "</style></td><script src=\"x\">&'\x01";
constexpr const char* kHostileRead = "</style></td><script src=\"x\">&'\uFFFD";

Page full_page(const std::string& text)
{
    Page page(text);
    page.verdict(text, false);
    page.heading(text);
    page.subheading(text);
    page.paragraph(text);
    page.table({{{text, false}, {text}}, {{{text}, {text, true}}, {{text}}}});
    page.tables({{text, facts({{text, text}})}});
    page.drawings({draw(LinePlot{text, {text}, {text}, {{text, {{1.0, 1.0, text}}}}})});
    return page;
}

TEST(Page, is_well_formed_whatever_is_in_it)
{
    const auto read = tactus::test::read_markup(full_page(kHostile).html());
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->count("script"), 0U);
    EXPECT_EQ(read->count("style"), 1U);
    EXPECT_EQ(read->count("table"), 2U);
    EXPECT_EQ(read->count("svg"), 1U);
    EXPECT_GE(std::ranges::count(read->texts, kHostileRead), 12);
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

TEST(Page, has_rules_for_paper_phone_and_dark)
{
    const std::string html = Page("title").html();
    EXPECT_NE(html.find("@media print"), std::string::npos);
    EXPECT_NE(html.find("prefers-color-scheme: dark"), std::string::npos);
    EXPECT_EQ(count_of(html, "(prefers-color-scheme: dark)"),
              count_of(html, "@media screen and (prefers-color-scheme: dark)")); // Paper is white.
    EXPECT_NE(html.find("width=device-width"), std::string::npos);
}

TEST(Page, tables_mark_what_is_missed_and_fill_short_lines)
{
    Page page("title");
    page.table({{{"case", false}, {"p50"}, {"p99"}}, {{{"cow"}, {"1.5", true}}}});
    const std::string html = page.html();
    EXPECT_EQ(count_of(html, "<td class=\"number missed\">1.5</td>"), 1U);
    EXPECT_EQ(count_of(html, "<td class=\"number\"></td>"), 1U);
    EXPECT_EQ(count_of(html, "<th scope=\"row\">cow</th>"), 1U);
    EXPECT_EQ(count_of(html, "<th scope=\"col\" class=\"number\">p99</th>"), 1U);
}

TEST(Page, a_table_without_names_has_no_head)
{
    Page page("title");
    page.table(facts({{"a", "b"}}));
    const auto read = tactus::test::read_markup(page.html());
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->count("thead"), 0U);
    EXPECT_EQ(read->count("tr"), 1U);
}

TEST(Page, the_same_calls_make_the_same_bytes)
{
    EXPECT_EQ(full_page("text").html(), full_page("text").html());
}

TEST(Page, without_anything_is_a_page)
{
    Page page("");
    page.drawings({});
    page.tables({});
    page.table({});
    EXPECT_TRUE(tactus::test::read_markup(page.html()).has_value());
}

} // namespace

} // namespace tactus::plot::test
