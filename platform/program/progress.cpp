// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/progress.hpp"

#include "transport/base/program_log.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::chrono::seconds kQuiet{2};
constexpr std::chrono::seconds kPlainPeriod{10};
constexpr std::chrono::milliseconds kTerminalPeriod{200};

} // namespace

Progress::Progress(std::string program, std::string what, std::string items)
    : program_(std::move(program))
    , what_(std::move(what))
    , items_(std::move(items))
    , is_terminal_(::isatty(STDERR_FILENO) == 1 && !log_style().is_json)
    , start_(Clock::now())
    , last_(start_)
{
}

Progress::~Progress()
{
    if (has_line_ && is_terminal_)
    {
        std::fputs("\r\x1b[K", stderr);
        std::fflush(stderr);
    }
}

void Progress::update(std::size_t done, std::size_t total)
{
    const Clock::time_point now = Clock::now();
    if (done == 0 || total < done || !is_due(now))
    {
        return;
    }
    last_ = now;
    has_line_ = true;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double rate = static_cast<double>(done) / seconds;
    const std::string line =
        fmt::format("{}: {:.0f} %, {:.0f} {} per second, {:.0f} s left", what_,
                    100.0 * static_cast<double>(done) / static_cast<double>(total), rate, items_,
                    static_cast<double>(total - done) / rate);
    if (!is_terminal_)
    {
        log_message(LogLevel::info, program_, line);
        return;
    }
    std::fputs(fmt::format("\r{}\x1b[K", line).c_str(), stderr);
    std::fflush(stderr);
}

bool Progress::is_due(Clock::time_point now) const
{
    if (now - start_ < kQuiet || !is_logged(LogLevel::info))
    {
        return false;
    }
    return !has_line_ ||
           (is_terminal_ ? now - last_ >= kTerminalPeriod : now - last_ >= kPlainPeriod);
}

} // namespace tactus
