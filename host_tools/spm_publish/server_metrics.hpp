// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_publish/edited_models.hpp"
#include "host_tools/web/metrics_server.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/telemetry.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace tactus
{

/// Metrics of a server and of the controllers on its domain, in Prometheus' text format
/// (docs/view.md). `edited` may be null.
[[nodiscard]] std::string server_metrics(dds::DdsServer& server,
                                         const dds::TelemetryReader& controllers,
                                         const EditedModels* edited);

/// Keeps the metrics page of a server up to date, to the second.
class ServerMetrics
{
public:
    explicit ServerMetrics(std::unique_ptr<web::MetricsServer> page) : page_(std::move(page)) {}

    /// Publishes new metrics if a second has passed. Call it often, after controllers.poll().
    void update(dds::DdsServer& server, const dds::TelemetryReader& controllers,
                const EditedModels* edited);

private:
    using Clock = std::chrono::steady_clock;

    std::unique_ptr<web::MetricsServer> page_;
    Clock::time_point last_{};
};

} // namespace tactus
