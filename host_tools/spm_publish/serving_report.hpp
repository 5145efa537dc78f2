// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/program_log.hpp"
#include "transport/dds/dds_host.hpp"

#include <chrono>
#include <cstddef>
#include <string>

namespace tactus
{

/// Prints the server's present work on stdout: on a terminal one line that is overwritten a few
/// times a second; otherwise a plain line every few seconds while something is sent.
class ServingReport
{
public:
    ServingReport();
    /// Ends the line on a terminal.
    ~ServingReport();
    ServingReport(const ServingReport&) = delete;
    ServingReport& operator=(const ServingReport&) = delete;

    /// Prints a separate line above the overwritten one, in the style of the log.
    void print_line(const std::string& line, LogLevel level = LogLevel::info);
    /// Prints if due. Call it often.
    void update(const dds::DdsHost& host);

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] std::string rates(const dds::DdsHost& host, double seconds) const;
    void clear_line();

    bool is_terminal_;
    std::size_t line_length_{0};
    Clock::time_point last_{Clock::now()};
    dds::DdsHost::Counters shown_;
};

} // namespace tactus
