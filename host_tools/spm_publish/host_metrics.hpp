// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/web/metrics_server.hpp"
#include "transport/dds/dds_host.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace tactus
{

/// Metrics of a server and of the controllers on its domain, in Prometheus' text format
/// (docs/view.md).
[[nodiscard]] std::string host_metrics(dds::DdsHost& host, const dds::TelemetryReader& controllers);

/// Keeps /metrics up to date, to the second.
class HostMetrics
{
public:
    explicit HostMetrics(std::unique_ptr<web::MetricsServer> server) : server_(std::move(server)) {}

    /// Updates the metrics if due. Call it often, after the reader's poll().
    void update(dds::DdsHost& host, const dds::TelemetryReader& controllers);

private:
    using Clock = std::chrono::steady_clock;

    std::unique_ptr<web::MetricsServer> server_;
    Clock::time_point last_{};
};

} // namespace tactus
