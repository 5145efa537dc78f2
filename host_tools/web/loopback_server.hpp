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

/// Content type of Prometheus' text format.
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Answers with a line of text.
void answer(httplib::Response& response, int status, const std::string& text);

/// The library's server with connections that yield to others (Connections).
class PatientServer final : public httplib::Server
{
public:
    explicit PatientServer(std::size_t threads);

private:
    bool process_and_close_socket(socket_t socket) override;

    Connections connections_;
};

/// HTTP server on this machine's loopback: GET only, no other Host name, no ranges, no cross-origin
/// use, no foreign content in its pages, no connection that idles while another one waits. Declare
/// its answers on server() before start().
class LoopbackServer
{
public:
    explicit LoopbackServer(std::size_t threads);
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;
    /// Waits for the requests being answered.
    ~LoopbackServer();

    [[nodiscard]] httplib::Server& server() noexcept { return server_; }

    /// Listens on 127.0.0.1, on its own thread. Port 0: any free one. Refused if the port is not
    /// available; the message recommends `option` for another one.
    [[nodiscard]] std::optional<Refusal> start(std::uint16_t port, const char* option);

    [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

private:
    [[nodiscard]] bool is_refused(const httplib::Request& request, httplib::Response& response);
    [[nodiscard]] bool is_ours(const std::string& authority) const;

    PatientServer server_;
    std::uint16_t port_{0};
    /// True once the listener has ended, possibly because accept() failed.
    std::atomic<bool> has_ended_{false};
    std::thread listener_;
};

} // namespace tactus::web
