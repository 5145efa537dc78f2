// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

// Any thread except the haptic one: strings allocate, and a write to stderr may wait.
namespace tactus
{

/// Severity of a line of a program's log.
enum class LogLevel : std::uint8_t
{
    error,   ///< The program cannot do its task.
    warning, ///< The program continues, but data were lost or refused, or a setting is wrong.
    info,    ///< Normal operation.
};
inline constexpr std::size_t kLogLevels = 3;
/// Names in the order of LogLevel.
inline constexpr std::array<const char*, kLogLevels> kLogLevelNames{"error", "warning", "info"};

/// Selection and format of the log.
struct LogStyle
{
    LogLevel least{LogLevel::info}; ///< Least severe level that is logged.
    bool is_json{false};            ///< True for one JSON object a line.
};

/// Sets the style. Call it once, before other threads log.
void set_log_style(const LogStyle& style) noexcept;
[[nodiscard]] const LogStyle& log_style() noexcept;

/// Line of the log in a style, without newline. Text style: "PROGRAM: " precedes errors and
/// warnings, but not info. JSON style: an object with the keys `time` (UTC), `level`, `program` and
/// `text`. `text` passes printable_line().
[[nodiscard]] std::string log_text(const LogStyle& style, LogLevel level, std::string_view program,
                                   std::string_view text,
                                   std::chrono::system_clock::time_point now);

/// True if lines of this level are logged.
[[nodiscard]] bool is_logged(LogLevel level) noexcept;

/// Writes a line to stderr if its level is logged.
void log_message(LogLevel level, std::string_view program, std::string_view text);

} // namespace tactus
