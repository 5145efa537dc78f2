// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/markup.hpp"
#include "platform/plot/page.hpp"
#include "platform/plot/relief.hpp"
#include "tests/shared/count_of.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <limits>
#include <string>

/// No text can break a page's form. An XML parser checks that pages are well-formed in
/// integration.hrtc_bad_input.
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
    EXPECT_EQ(escaped("\xC3"), "\uFFFD");           // Truncated.
    EXPECT_EQ(escaped("\xC0\xAF"), "\uFFFD\uFFFD"); // Overlong.
    EXPECT_EQ(escaped("\xE0\x80\xBC"), "\uFFFD\uFFFD\uFFFD");
    EXPECT_EQ(escaped("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD"); // Half of a UTF-16 surrogate pair.
    EXPECT_EQ(escaped("\xEF\xBF\xBF"), "\uFFFD\uFFFD\uFFFD");
    EXPECT_EQ(escaped("\xC2\x85"), "\uFFFD\uFFFD"); // Control character beyond ASCII.
    EXPECT_EQ(escaped("\t\n\r"), "\t\n\uFFFD");
}

Page full_page(const std::string& text)
{
    Page page(text, {"draw();", "p { order: 0; }", ""});
    page.verdict(text, false);
    page.heading(text);
    page.paragraph(text);
    page.table({{{text, false}, {text}}, {{text, text}, {text}}});
    page.tables({{text, facts({{text, text}})}});
    page.charts({{.title = text,
                  .x_label = text,
                  .y_label = text,
                  .kind = Chart::Kind::series,
                  .x = {0.0, 1.0},
                  .lines = {{text, {1.0 / 3.0, std::numeric_limits<double>::quiet_NaN()}}},
                  .marks = {{0.5, text, MarkKind::fault}}}});
    return page;
}

/// Text of the element with this start.
std::string element(const std::string& html, const std::string& begin)
{
    const std::size_t at = html.find(begin) + begin.size();
    return html.substr(at, html.find("</script>", at) - at);
}

TEST(Page, escapes_whatever_is_in_it)
{
    const std::string text = "</td>\"</script><!-- ]]> &amp; \x1B\xFF";
    const std::string html = full_page(text).html();
    EXPECT_EQ(count_of(html, "</script>"), 3U); // Data, library, drawing code.
    EXPECT_EQ(count_of(html, "]]>"), 3U);       // Style, library, drawing code.
    EXPECT_EQ(html.find("<!--"), std::string::npos);
    EXPECT_EQ(count_of(html, "</td>"), count_of(html, "<td"));
    EXPECT_EQ(count_of(html, "&lt;/td&gt;&quot;"), 14U); // Each of its texts.
    const std::string json = element(html, "id=\"chart-data\">");
    EXPECT_EQ(json.find_first_of("<>&"), std::string::npos) << json;
    const auto charts = nlohmann::json::parse(json);
    EXPECT_EQ(charts[0]["title"], "</td>\"</script><!-- ]]> &amp; \x1B\uFFFD");
    EXPECT_EQ(charts[0]["title"], charts[0]["marks"][0]["name"]);
    EXPECT_EQ(charts[0]["lines"][0]["y"], nlohmann::json({0.333333, nullptr}));
}

TEST(Page, has_the_library_once_and_only_for_charts)
{
    Page twice = full_page("text");
    twice.charts({Chart{}});
    EXPECT_EQ(count_of(twice.html(), "draw();"), 1U);
    EXPECT_EQ(count_of(twice.html(), "<div class=\"chart\">"), 2U);
    Page none("text", {"draw();", "p { order: 0; }", ""});
    none.charts({});
    EXPECT_EQ(count_of(none.html(), "<script") + count_of(none.html(), "order: 0"), 0U);
}

TEST(Page, says_why_it_has_no_charts)
{
    Page page("text", {"draw();", "", "a & b is missing"});
    page.charts({Chart{}, Chart{}});
    EXPECT_EQ(count_of(page.html(), "2 charts are left out: a &amp; b is missing"), 1U);
    EXPECT_EQ(count_of(page.html(), "<script"), 0U);
}

TEST(Page, needs_nothing_from_elsewhere)
{
    const std::string html = full_page("text").html();
    for (const char* way : {"<link", "<img", "@import", "url(", "href", " src="})
    {
        EXPECT_EQ(html.find(way), std::string::npos) << way;
    }
    // A script could not be loaded either.
    EXPECT_EQ(count_of(html, "content=\"default-src 'none';"), 1U);
    std::size_t addresses = count_of(html, "http");
    addresses -= count_of(html, "\"http://www.w3.org/1999/xhtml\"");
    addresses -= count_of(html, "http-equiv");
    EXPECT_EQ(addresses, 0U); // The remaining ones are names of languages.
}

struct LibraryFolder
{
    LibraryFolder() { std::filesystem::create_directories(folder.path() / "dygraphs"); }
    [[nodiscard]] ChartLibrary read(const std::string& script, const std::string& style) const
    {
        folder.write("dygraphs/dygraph.min.js", script);
        folder.write("dygraphs/dygraph.min.css", style);
        return ChartLibrary::read(folder.path());
    }

    tactus::test::TemporaryFolder folder{"library"};
};

TEST(ChartLibrary, is_refused_where_it_would_end_its_element)
{
    const LibraryFolder library;
    EXPECT_EQ(library.read("a </div>", "b").missing, "");
    EXPECT_EQ(library.read("a </div>", "b").script, "a </div>");
    EXPECT_EQ(library.read("a </div>", "b").style, "b");
    for (const char* end : {"</script>", "</SCRIPT >", "</Style>", "<!--", "]]>"})
    {
        const std::string hostile = std::string("a ") + end + " b";
        EXPECT_NE(library.read(hostile, "b").missing, "") << end;
        EXPECT_NE(library.read("a", hostile).missing, "") << end;
    }
}

TEST(ChartLibrary, that_is_not_there_is_told_by_its_file_and_package)
{
    const LibraryFolder library;
    for (const char* file : {"dygraph.min.js", "dygraph.min.css"})
    {
        ASSERT_EQ(library.read("a", "b").missing, "");
        std::filesystem::remove(library.folder.path() / "dygraphs" / file);
        const std::string missing = ChartLibrary::read(library.folder.path()).missing;
        EXPECT_NE(missing.find(file), std::string::npos) << missing;
        EXPECT_NE(missing.find("libjs-dygraphs"), std::string::npos) << missing;
    }
    EXPECT_NE(library.read("", "b").missing, "");
}

using tactus::test::count_of;

/// Square of a metre on the ground, of two faces.
Relief ground()
{
    return {.title = "way & force",
            .faces = {{{{-0.5F, -0.5F, 0.0F}, {0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 0.0F}}},
                      {{{-0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 0.0F}, {-0.5F, 0.5F, 0.0F}}}},
            .ways = {},
            .unit = "N",
            .note = {}};
}

TEST(Relief, draws_each_face_and_each_change_of_the_amount)
{
    Relief relief = ground();
    relief.ways = {{{{-0.5F, 0.0F, 0.2F}, 0.0F},
                    {{0.0F, 0.0F, 0.1F}, 0.0F},
                    {{0.1F, 0.0F, 0.0F}, 1.0F},
                    {{0.2F, 0.0F, 0.0F}, 0.95F},
                    {{0.5F, 0.0F, 0.0F}, 0.1F}}};
    const std::string sut = figure_of(relief);
    EXPECT_EQ(count_of(sut, "Z\"/>"), 2U);
    EXPECT_EQ(count_of(sut, "class=\"w w0\""), 1U);
    EXPECT_EQ(count_of(sut, "class=\"w w5\""), 1U);
    EXPECT_EQ(count_of(sut, "class=\"w w1\""), 1U);
    EXPECT_EQ(count_of(sut, "<svg"), 1U) << "a way across all needs no second view";
    EXPECT_NE(sut.find("way &amp; force"), std::string::npos);
    EXPECT_NE(sut.find(" 1 N at most"), std::string::npos);
}

TEST(Relief, has_a_view_of_its_own_for_a_way_that_takes_little_room)
{
    Relief relief = ground();
    relief.ways = {{{{0.0F, 0.0F, 0.0F}, 1.0F}, {{0.01F, 0.0F, 0.0F}, 2.0F}}};
    const std::string sut = figure_of(relief);
    EXPECT_EQ(count_of(sut, "<svg"), 2U);
    EXPECT_EQ(count_of(sut, "href=\"#relief\""), 1U);
}

TEST(Relief, draws_what_is_nearer_to_the_eye_over_what_is_farther)
{
    Relief relief;
    const auto face_at = [](float z) {
        return std::array<Place, 3>{{{0.0F, 0.0F, z}, {1.0F, 0.0F, z}, {1.0F, 1.0F, z}}};
    };
    relief.faces = {face_at(1.0F), face_at(0.0F)}; // View from above.
    const std::string one = figure_of(relief);
    relief.faces = {face_at(0.0F), face_at(1.0F)};
    EXPECT_EQ(one, figure_of(relief));
}

TEST(Relief, of_nothing_or_of_no_number_is_empty)
{
    EXPECT_EQ(figure_of({}), "");
    Relief relief = ground();
    relief.faces[0][0][0] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(figure_of(relief), "");
    relief.faces.clear();
    relief.ways = {{}};
    EXPECT_EQ(figure_of(relief), "");
}

} // namespace
} // namespace tactus::plot::test
