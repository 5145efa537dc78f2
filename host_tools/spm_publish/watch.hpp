// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_publish/serving_report.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace tactus
{

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
