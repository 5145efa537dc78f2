// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/metrics_server.hpp"

#include "host_tools/web/loopback_server.hpp"

#include <mutex>
#include <utility>

namespace tactus::web
{

namespace
{

/// Enough for a scraper and a person; silent connections are closed if others wait.
constexpr std::size_t kThreads = 6;

} // namespace

struct MetricsServer::Inside
{
    std::mutex mutex;
    std::string text;
    LoopbackServer local{kThreads}; ///< Last member, since its threads use the others.
};

Result<std::unique_ptr<MetricsServer>, Refusal> MetricsServer::start(std::uint16_t port,
                                                                     const char* option)
{
    auto inside = std::make_unique<Inside>();
    inside->local.server().Get(
        "/metrics",
        [&told = *inside](const httplib::Request&, httplib::Response& response)
        {
            const std::lock_guard lock(told.mutex);
            response.set_content(told.text, kMetricsType);
        });
    if (auto refusal = inside->local.start(port, option))
    {
        return *refusal;
    }
    return std::unique_ptr<MetricsServer>(new MetricsServer(std::move(inside)));
}

MetricsServer::MetricsServer(std::unique_ptr<Inside> inside) : inside_(std::move(inside)) {}

MetricsServer::~MetricsServer() = default;

void MetricsServer::publish(std::string text)
{
    const std::lock_guard lock(inside_->mutex);
    inside_->text = std::move(text);
}

std::uint16_t MetricsServer::port() const noexcept
{
    return inside_->local.port();
}

} // namespace tactus::web
