// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "transport/base/print_assertions.hpp"
#include "transport/base/program_log.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

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
        "assertion failed: 1 \\+ 1 == 3 \\(.*test_program_log.cpp:[0-9]+\\)");
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

} // namespace tactus::test
