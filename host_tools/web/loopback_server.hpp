// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/web/peer_stream.hpp"
#include "transport/base/refusal.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <httplib.h>
#include <optional>
#include <string>
#include <thread>

namespace tactus::web
{

/// HTTP content type of the text format of Prometheus.
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Sets the response to a status and a line of plain text.
void answer(httplib::Response& response, int status, const std::string& text);

/// cpp-httplib's server, whose connections give up their threads to others (Connections).
class PatientServer final : public httplib::Server
{
public:
    explicit PatientServer(std::size_t threads);

private:
    bool process_and_close_socket(socket_t socket) override;

    Connections connections_;
};

/// HTTP server on this machine's loopback interface. Accepts only GET and its own Host name,
/// ignores ranges, refuses requests and content of other origins, and closes idle connections while
/// others wait. Declare its answers on server() before start().
class LoopbackServer
{
public:
    explicit LoopbackServer(std::size_t threads);
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;
    /// Waits until the requests in progress are answered.
    ~LoopbackServer();

    [[nodiscard]] httplib::Server& server() noexcept { return server_; }

    /// Listens on 127.0.0.1, on a thread of its own. Port 0 takes any free port. Refused if the
    /// port is not free; the message names `option`, which sets another port.
    [[nodiscard]] std::optional<Refusal> start(std::uint16_t port, const char* option);

    [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

private:
    [[nodiscard]] bool is_refused(const httplib::Request& request, httplib::Response& response);
    [[nodiscard]] bool is_ours(const std::string& authority) const;

    PatientServer server_;
    std::uint16_t port_{0};
    /// True once the listening thread has ended, for example because accept() failed.
    std::atomic<bool> has_ended_{false};
    std::thread listener_;
};

} // namespace tactus::web
