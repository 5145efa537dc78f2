// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

// Any thread, but not the haptic one: texts allocate, and stderr may wait.
namespace tactus
{

/// How much a line of a program's log matters.
enum class LogLevel : std::uint8_t
{
    error,   ///< The program can't do what it was asked.
    warning, ///< It goes on, but something was lost, refused or isn't as it should be.
    info,    ///< All is well.
};
inline constexpr std::size_t kLogLevels = 3;
/// In the order of LogLevel.
inline constexpr std::array<const char*, kLogLevels> kLogLevelNames{"error", "warning", "info"};

/// What the log tells, and how.
struct LogStyle
{
    LogLevel least{LogLevel::info}; ///< What matters less isn't told.
    bool is_json{false};            ///< A JSON object a line.
};

/// Once, before there are other threads that log.
void set_log_style(const LogStyle& style) noexcept;
[[nodiscard]] const LogStyle& log_style() noexcept;

/// A line as the style has it, without its end: errors and warnings behind the program's name, what
/// is info as it is; or an object with the keys `time` (UTC), `level`, `program` and `text`.
/// The line is shown as printable_line() shows it.
[[nodiscard]] std::string log_text(const LogStyle& style, LogLevel level, std::string_view program,
                                   std::string_view text,
                                   std::chrono::system_clock::time_point now);

/// Whether lines of this level are told.
[[nodiscard]] bool is_logged(LogLevel level) noexcept;

/// Tells a line on stderr, if it is to be told.
void log_message(LogLevel level, std::string_view program, std::string_view text);

} // namespace tactus
