// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_publish/serving_report.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace tactus
{

/// What a controller does at present, in one line: the names in it are valid ones.
[[nodiscard]] std::string watch_line(const dds::WatchedController& controller);

/// Prints one line a second for each controller on the domain.
class Watch
{
public:
    explicit Watch(std::unique_ptr<dds::TelemetryReader> reader) : reader_(std::move(reader)) {}

    /// Call it often; it prints when it is due.
    void update(ServingReport& report);

private:
    using Clock = std::chrono::steady_clock;

    std::unique_ptr<dds::TelemetryReader> reader_;
    Clock::time_point last_{Clock::now()};
};

} // namespace tactus
