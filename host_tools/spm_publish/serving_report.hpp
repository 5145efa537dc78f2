// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/program_log.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace tactus
{

/// Prints the server's present work on stdout: on a terminal in one line, overwritten a few times a
/// second; otherwise in a new line every 5 s while pieces are sent.
class ServingReport
{
public:
    ServingReport();
    /// Ends the overwritten line.
    ~ServingReport();
    ServingReport(const ServingReport&) = delete;
    ServingReport& operator=(const ServingReport&) = delete;

    /// Prints a separate line above the overwritten one, in the style of the log.
    void print_line(const std::string& line, LogLevel level = LogLevel::info);
    /// Prints if the interval has passed. Call it often.
    void update(const dds::DdsServer& server);

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] std::string rates(const dds::DdsServer& server, double seconds) const;
    void clear_line();

    bool is_terminal_;
    std::size_t line_length_{0};
    Clock::time_point last_{Clock::now()};
    dds::DdsServer::Counters shown_;
};

/// Line about a controller's present state. Names in it are valid (is_valid_name()).
[[nodiscard]] std::string watch_line(const dds::WatchedController& controller);

/// Prints lines once a second: for each controller on the domain, for each controller that this
/// server sends to, and for each participant with refusals in that second.
class Watch
{
public:
    /// Prints if a second has passed. Call it often, after controllers.poll().
    void update(const dds::TelemetryReader& controllers, const dds::DdsServer& server,
                ServingReport& report);

private:
    using Clock = std::chrono::steady_clock;

    void print_served(const dds::DdsServer& server, double seconds, ServingReport& report);
    void print_refused(const dds::DdsServer& server, ServingReport& report);

    Clock::time_point last_{Clock::now()};
    /// Subscribers as printed last, by name of the controller.
    std::map<std::string, dds::DdsServer::Subscriber> served_;
    /// Total number of refusals as printed last, by participant.
    std::map<dds::ParticipantId, std::uint64_t> refused_;
};

} // namespace tactus
