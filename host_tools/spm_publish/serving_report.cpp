// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/serving_report.hpp"

#include "platform/program/run_program.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <unistd.h>

namespace tactus
{

namespace
{

constexpr auto kTerminalPeriod = std::chrono::milliseconds(250);
constexpr auto kPlainPeriod = std::chrono::seconds(5);

} // namespace

ServingReport::ServingReport()
    : is_terminal_(::isatty(STDOUT_FILENO) == 1 && !log_style().is_json &&
                   is_logged(LogLevel::info))
{
}

ServingReport::~ServingReport()
{
    clear_line();
}

void ServingReport::print_line(const std::string& line, LogLevel level)
{
    if (!is_logged(level))
    {
        return;
    }
    clear_line();
    // Without the program's name, which begins lines of level error: a fault of one controller is
    // no failure of the program.
    const LogLevel shown = log_style().is_json ? level : LogLevel::info;
    print_out(log_text(log_style(), shown, "spm_publish", line, std::chrono::system_clock::now()) +
              '\n');
}

void ServingReport::update(const dds::DdsServer& server)
{
    const auto now = Clock::now();
    const std::chrono::duration<double> passed = now - last_;
    if (passed < (is_terminal_ ? std::chrono::nanoseconds(kTerminalPeriod) : kPlainPeriod))
    {
        return;
    }
    const auto counters = server.counters();
    const bool has_sent = counters.pieces_sent != shown_.pieces_sent;
    const std::string line = rates(server, passed.count());
    last_ = now;
    shown_ = counters;
    if (is_terminal_)
    {
        clear_line();
        print_out(line);
        line_length_ = line.size();
    }
    else if (has_sent)
    {
        print_line(line);
    }
}

std::string ServingReport::rates(const dds::DdsServer& server, double seconds) const
{
    const auto counters = server.counters();
    const auto pieces = static_cast<double>(counters.pieces_sent - shown_.pieces_sent);
    const auto bytes = static_cast<double>(counters.bytes_sent - shown_.bytes_sent);
    return fmt::format("{}, {:.0f} chunks/s, {:.1f} KB/s, {} in all",
                       counted(server.subscribers().size(), "controller"), pieces / seconds,
                       bytes / seconds / 1e3, counted(counters.pieces_sent, "chunk"));
}

void ServingReport::clear_line()
{
    if (line_length_ > 0)
    {
        print_out(fmt::format("\r{:{}}\r", "", line_length_));
        line_length_ = 0;
    }
}

} // namespace tactus
