// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/program_log.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/base/print_assertions.hpp"
#include "transport/base/printable.hpp"

#include <cstdio>
#include <ctime>

namespace tactus
{

namespace
{

LogStyle style_of_all;

/// JSON string of a line that passed printable_line().
std::string json_text(std::string_view text)
{
    std::string json = "\"";
    for (const char c : text)
    {
        json += c == '"' || c == '\\' ? "\\" : "";
        json += c;
    }
    return json + '"';
}

/// Time in RFC 3339, to the millisecond.
std::string time_text(std::chrono::system_clock::time_point now)
{
    using std::chrono::milliseconds;
    const auto since = std::chrono::floor<milliseconds>(now.time_since_epoch());
    const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
    const auto calendar = static_cast<std::time_t>(seconds.count());
    std::tm parts{};
    gmtime_r(&calendar, &parts);
    std::array<char, 80> text{};
    const auto length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
    std::snprintf(text.data() + length, text.size() - length, ".%03dZ",
                  static_cast<int>((since - seconds).count()));
    return text.data();
}

} // namespace

void set_log_style(const LogStyle& style) noexcept
{
    style_of_all = style;
}

const LogStyle& log_style() noexcept
{
    return style_of_all;
}

std::string log_text(const LogStyle& style, LogLevel level, std::string_view program,
                     std::string_view text, std::chrono::system_clock::time_point now)
{
    const std::string line = printable_line(text);
    const std::string name(program);
    if (!style.is_json)
    {
        return level == LogLevel::info ? line : name + ": " + line;
    }
    return R"({"time":")" + time_text(now) + R"(","level":")" +
           kLogLevelNames[static_cast<std::size_t>(level)] + R"(","program":)" + json_text(name) +
           R"(,"text":)" + json_text(line) + "}";
}

bool is_logged(LogLevel level) noexcept
{
    return level <= style_of_all.least;
}

void log_message(LogLevel level, std::string_view program, std::string_view text)
{
    if (is_logged(level))
    {
        const std::string line =
            log_text(style_of_all, level, program, text, std::chrono::system_clock::now()) + '\n';
        std::fputs(line.c_str(), stderr);
    }
}

namespace
{

void print_assertion(const char* condition, const char* file, int line) noexcept
{
    static_cast<void>(
        std::fprintf(stderr, "assertion failed: %s (%s:%d)\n", condition, file, line));
}

} // namespace

void print_failed_assertions() noexcept
{
    if (const AssertHandler before = set_assert_handler(print_assertion); before != nullptr)
    {
        set_assert_handler(before);
    }
}

} // namespace tactus
