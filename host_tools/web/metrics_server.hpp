// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace tactus::web
{

/// Serves /metrics for Prometheus on this machine's loopback interface: the newest published text.
/// Answers on threads of its own, which never wait for the caller.
class MetricsServer
{
public:
    /// Starts the server. Port 0 takes any free port. Refused if the port is not free; the message
    /// names `option`, which sets another port.
    [[nodiscard]] static Result<std::unique_ptr<MetricsServer>, Refusal> start(std::uint16_t port,
                                                                               const char* option);
    MetricsServer(const MetricsServer&) = delete;
    MetricsServer& operator=(const MetricsServer&) = delete;
    ~MetricsServer();

    /// Sets the text of all later answers. Any thread.
    void publish(std::string text);
    [[nodiscard]] std::uint16_t port() const noexcept;

private:
    struct Inside;

    explicit MetricsServer(std::unique_ptr<Inside> inside);

    std::unique_ptr<Inside> inside_;
};

} // namespace tactus::web
