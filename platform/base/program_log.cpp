// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/base/program_log.hpp"

#include "platform/base/printable.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace tactus
{

namespace
{

LogStyle style_of_all;

/// How many bytes the character has that begins the text; 0: it is no UTF-8 (RFC 3629).
std::size_t character_bytes(std::string_view text) noexcept
{
    const auto byte = [text](std::size_t i)
    { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const unsigned first = byte(0);
    const std::size_t count = first < 0x80                     ? 1
                              : first >= 0xC2 && first < 0xE0  ? 2
                              : first >= 0xE0 && first < 0xF0  ? 3
                              : first >= 0xF0 && first <= 0xF4 ? 4
                                                               : 0;
    for (std::size_t i = 1; i < count; ++i)
    {
        // The second one also says whether fewer bytes would have done, and what is none.
        const unsigned least = i > 1 ? 0x80 : first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
        const unsigned most = i > 1 ? 0xBF : first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
        if (byte(i) < least || byte(i) > most)
        {
            return 0;
        }
    }
    return count;
}

std::string json_text(std::string_view text)
{
    std::string json = "\"";
    while (!text.empty())
    {
        const std::size_t bytes = character_bytes(text);
        json += text[0] == '"' || text[0] == '\\' ? "\\" : "";
        json += bytes == 0 ? "?" : text.substr(0, bytes);
        text.remove_prefix(std::max<std::size_t>(bytes, 1));
    }
    return json + '"';
}

/// RFC 3339, to the millisecond.
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

} // namespace tactus
