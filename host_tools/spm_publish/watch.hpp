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

/// One line about a controller's present state; names in it are valid ones.
[[nodiscard]] std::string watch_line(const dds::WatchedController& controller);

/// Prints once a second: a line for each controller on the domain, one for each that this server
/// sends to, and one for each participant with refusals in that second.
class Watch
{
public:
    /// Prints if due. Call it often, after the reader's poll().
    void update(const dds::TelemetryReader& controllers, const dds::DdsHost& host,
                ServingReport& report);

private:
    using Clock = std::chrono::steady_clock;

    void print_served(const dds::DdsHost& host, double seconds, ServingReport& report);
    void print_refused(const dds::DdsHost& host, ServingReport& report);

    Clock::time_point last_{Clock::now()};
    /// Subscribers as last printed, by name.
    std::map<std::string, dds::DdsHost::Subscriber> served_;
    /// Total refusals as last printed, by participant.
    std::map<dds::ParticipantId, std::uint64_t> refused_;
};

} // namespace tactus
