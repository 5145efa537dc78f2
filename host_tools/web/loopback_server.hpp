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

/// What a response of Prometheus' text format calls itself.
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Answers with a line of text.
void answer(httplib::Response& response, int status, const std::string& text);

/// The library's server, with connections that give way to others (Connections).
class PatientServer final : public httplib::Server
{
public:
    explicit PatientServer(std::size_t threads);

private:
    bool process_and_close_socket(socket_t socket) override;

    Connections connections_;
};

/// A server of this machine's loopback alone: GET only, no other host's name, no parts of answers,
/// nothing for other pages, nothing of others in ours, no connection that idles while another one
/// waits. What it answers is declared on server() before start().
class LoopbackServer
{
public:
    explicit LoopbackServer(std::size_t threads);
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;
    /// Waits for the requests that are being answered.
    ~LoopbackServer();

    [[nodiscard]] httplib::Server& server() noexcept { return server_; }

    /// Listens on 127.0.0.1, on a thread of its own. Port 0: any that is free. Refused when the
    /// port can't be had; `option` is named as what gives another.
    [[nodiscard]] std::optional<Refusal> start(std::uint16_t port, const char* option);

    [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

private:
    [[nodiscard]] bool is_refused(const httplib::Request& request, httplib::Response& response);
    [[nodiscard]] bool is_ours(const std::string& authority) const;

    PatientServer server_;
    std::uint16_t port_{0};
    std::atomic<bool> has_ended_{false}; ///< The listener, by itself where accept() fails.
    std::thread listener_;
};

} // namespace tactus::web
