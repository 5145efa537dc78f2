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

/// /metrics on this machine's loopback, for Prometheus: the newest text that was told. Requests
/// are answered on threads of its own and wait for nobody.
class MetricsServer
{
public:
    /// Port 0: any that is free. Refused when the port can't be had; `option` gave it.
    [[nodiscard]] static Result<std::unique_ptr<MetricsServer>, Refusal> start(std::uint16_t port,
                                                                               const char* option);
    MetricsServer(const MetricsServer&) = delete;
    MetricsServer& operator=(const MetricsServer&) = delete;
    ~MetricsServer();

    /// Any thread: what is answered from now on.
    void publish(std::string text);
    [[nodiscard]] std::uint16_t port() const noexcept;

private:
    struct Inside;

    explicit MetricsServer(std::unique_ptr<Inside> inside);

    std::unique_ptr<Inside> inside_;
};

} // namespace tactus::web
