// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/print_assertions.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/program_log.hpp"
#include "transport/base/suggestions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr LogStyle kPlain{};
constexpr LogStyle kJson{LogLevel::info, true};

/// 2026-11-25 22:40:05.007 UTC.
constexpr std::chrono::system_clock::time_point kThen{std::chrono::milliseconds(1'795'646'405'007)};

TEST(ProgramLog, names_the_program_before_what_is_wrong)
{
    EXPECT_EQ(log_text(kPlain, LogLevel::error, "hrtc", "no such file", kThen),
              "hrtc: no such file");
    EXPECT_EQ(log_text(kPlain, LogLevel::warning, "hrtc", "the server is gone", kThen),
              "hrtc: the server is gone");
    EXPECT_EQ(log_text(kPlain, LogLevel::info, "hrtc", "touch: 50 %", kThen), "touch: 50 %");
}

TEST(ProgramLog, stays_on_one_line)
{
    EXPECT_EQ(log_text(kPlain, LogLevel::error, "hrtc", "a\nb\x1b[2J", kThen), "hrtc: a?b?[2J");
}

TEST(ProgramLog, makes_an_object_of_each_line)
{
    EXPECT_EQ(log_text(kJson, LogLevel::warning, "hrtc", "a \"b\\c\"\n", kThen),
              R"({"time":"2026-11-25T22:40:05.007Z","level":"warning","program":"hrtc",)"
              R"("text":"a \"b\\c\"?"})");
}

/// Text of a log line in JSON.
std::string text_of(const std::string& text)
{
    const std::string line = log_text(kJson, LogLevel::info, "p", text, kThen);
    const std::string before = R"("text":")";
    const std::size_t at = line.find(before) + before.size();
    return line.substr(at, line.size() - at - 2);
}

TEST(ProgramLog, leaves_utf_8_as_it_is_and_shows_what_is_none)
{
    for (const char* whole : {"caf\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\xED\x9F\xBF",
                              "\xEE\x80\x80", "\xF4\x8F\xBF\xBF"})
    {
        EXPECT_EQ(text_of(whole), whole);
    }
    EXPECT_EQ(text_of("\xC3"), "?");                // Truncated.
    EXPECT_EQ(text_of("\xE2\x82"), "??");           // Truncated.
    EXPECT_EQ(text_of("\xC3(\xA9"), "?(?");         // Interrupted.
    EXPECT_EQ(text_of("\xC0\xAF"), "??");           // Overlong.
    EXPECT_EQ(text_of("\xE0\x80\xAF"), "???");      // Overlong.
    EXPECT_EQ(text_of("\xED\xA0\x80"), "???");      // Half of a surrogate pair.
    EXPECT_EQ(text_of("\xF4\x90\x80\x80"), "????"); // Beyond the last code point.
    EXPECT_EQ(text_of("\xFF"
                      "end"),
              "?end");
}

TEST(ProgramLog, tells_what_matters_as_much_as_is_asked)
{
    const LogStyle before = log_style();
    for (const LogLevel least : {LogLevel::error, LogLevel::warning, LogLevel::info})
    {
        set_log_style({least, false});
        for (const LogLevel level : {LogLevel::error, LogLevel::warning, LogLevel::info})
        {
            ::testing::internal::CaptureStderr();
            log_message(level, "p", "text");
            const std::string told = ::testing::internal::GetCapturedStderr();
            EXPECT_EQ(!told.empty(), level <= least);
            EXPECT_EQ(is_logged(level), level <= least);
        }
    }
    set_log_style(before);
}

} // namespace

TEST(PrintAssertionsDeathTest, says_what_failed_and_where_before_the_process_stops)
{
    EXPECT_DEATH(
        {
            print_failed_assertions();
            TACTUS_ASSERT(1 + 1 == 3);
        },
        "assertion failed: 1 \\+ 1 == 3 \\(.*test_texts.cpp:[0-9]+\\)");
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

namespace
{

constexpr NumberRange kLength{1e-5, 1.0, "m"};
constexpr NumberRange kOfBox[] = {kLength, kLength, kLength, {1e-5, 1.0, "m", true}};
constexpr NumberForm kBox{"box:X,Y,Z[,R]", kOfBox};
constexpr NumberRange kAnywhere{-100.0, 100.0, "m"};
constexpr NumberRange kOfPlace[] = {kAnywhere, kAnywhere, {1.0, 2.0}};
constexpr NumberForm kPlace{"A,B[,C]", kOfPlace};

std::string refusal_of(std::string_view value, const NumberForm& form)
{
    const auto sut = read_numbers(value, form);
    return sut ? "" : sut.error().text;
}

TEST(NumberForm, takes_as_many_numbers_as_the_form_has_with_or_without_what_is_in_brackets)
{
    EXPECT_EQ(read_numbers("box:0.1,0.2,0.3", kBox).value(), (std::vector{0.1, 0.2, 0.3}));
    EXPECT_EQ(read_numbers("box:0.1,0.2,0.3,0", kBox).value(), (std::vector{0.1, 0.2, 0.3, 0.0}));
    EXPECT_EQ(read_numbers("-100,1e2,2", kPlace).value(), (std::vector{-100.0, 100.0, 2.0}));
}

TEST(NumberForm, names_the_one_fault_and_what_may_have_been_meant)
{
    const std::string box = " is not box:X,Y,Z[,R]: ";
    const std::string place = " is not A,B[,C]: ";
    for (const auto& [value, fault] : {
             std::pair("box:2mm,1,1", box + "X must be in m, without a unit; box:0.002,1,1?"),
             std::pair("box:1,1e0cm,1,1in",
                       box + "Y must be in m, without a unit; box:1,0.01,1,0.0254?"),
             std::pair("box:5,1,1", box + "X is 5, not in 1e-05 .. 1 m; box:0.005,1,1?"),
             std::pair("box:5000,1,1", box + "X is 5000, not in 1e-05 .. 1 m"),
             std::pair("box:1,1,1,1e-6", box + "R is 1e-6, not in 1e-05 .. 1 m, nor 0"),
             std::pair("box:1,1", box + "the value has 2 numbers"),
             std::pair("box:1,1,1,1,1", box + "the value has 5 numbers"),
             std::pair("box:", box + "X is missing"),
             std::pair("box:1,,1", box + "Y is missing"),
             std::pair("box:1,1,wide", box + "Z is 'wide', not a number"),
             std::pair("box:1,1,1 ", box + "Z is '1 ', not a number"),
             std::pair("box:1,1,1s", box + "Z is '1s', not a number"),
             std::pair("box:1,nan,1", box + "Y is 'nan', not a number"),
             std::pair("3", place + "the value has 1 number; 3,0?"),
             std::pair("30mm", place + "A must be in m, without a unit; 0.03,0?"),
             std::pair("1,2,1m", place + "C is '1m', not a number"),
             std::pair("1,2,3", place + "C is 3, not in 1 .. 2"),
             std::pair("1,2\n", place + "B is '2?', not a number"),
         })
    {
        const NumberForm& form = std::string_view(value).starts_with("box:") ? kBox : kPlace;
        const std::string shown = std::string(value) == "1,2\n" ? "1,2?" : value;
        EXPECT_EQ(refusal_of(value, form), "'" + shown + "'" + fault);
    }
}

/// A proposed value is accepted.
TEST(NumberForm, means_nothing_that_it_would_refuse)
{
    for (const char* value : {"box:2mm,1,1", "box:5,1,1,0mm", "box:700,3cm,12in", "box:1,2"})
    {
        const std::string text = refusal_of(value, kBox);
        const std::size_t meant = text.rfind("; ");
        if (meant != std::string::npos)
        {
            EXPECT_EQ(refusal_of(text.substr(meant + 2, text.size() - meant - 3), kBox), "")
                << text;
        }
    }
}

TEST(NearestWord, is_the_one_with_the_fewest_other_letters)
{
    constexpr std::array<std::string_view, 4> kWords{"point", "sphere", "sphinx", "box"};
    EXPECT_EQ(nearest_word("shpere", kWords), "sphere");
    EXPECT_EQ(nearest_word("sphere", kWords), "sphere");
    EXPECT_EQ(nearest_word("spheres", kWords), "sphere");
    EXPECT_EQ(nearest_word("bo", kWords), "box");
    EXPECT_EQ(nearest_word("points", kWords), "point");
}

TEST(NearestWord, is_none_where_nothing_is_near)
{
    constexpr std::array<std::string_view, 3> kWords{"point", "sphere", "a"};
    EXPECT_EQ(nearest_word("capsule", kWords), "");
    EXPECT_EQ(nearest_word("", kWords), "");
    EXPECT_EQ(nearest_word("z", kWords), ""); // "z" shares no letter with "a".
    EXPECT_EQ(nearest_word("point", {}), "");
}

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
} // namespace tactus::test
