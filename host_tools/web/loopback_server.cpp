// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/loopback_server.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <string_view>
#include <sys/socket.h>

namespace tactus::web
{

namespace
{

/// For a request to come and an answer to be taken.
constexpr time_t kPatience_s = 2;

const httplib::Headers& safe_headers()
{
    static const httplib::Headers headers{
        {"Content-Security-Policy", "default-src 'self'; base-uri 'none'; form-action 'none'; "
                                    "frame-ancestors 'none'"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cache-Control", "no-store"}};
    return headers;
}

} // namespace

void answer(httplib::Response& response, int status, const std::string& text)
{
    response.status = status;
    response.set_content(text + "\n", "text/plain; charset=utf-8");
}

LoopbackServer::LoopbackServer(std::size_t threads)
{
    using httplib::Request;
    using httplib::Response;
    server_.new_task_queue = [threads] { return new httplib::ThreadPool(threads); }; // It owns it.
    server_.set_keep_alive_max_count(1); // One that idles would hold a thread.
    server_.set_read_timeout(kPatience_s);
    server_.set_write_timeout(kPatience_s);
    server_.set_payload_max_length(1);
    server_.set_default_headers(safe_headers());
    server_.set_pre_routing_handler(
        [this](const Request& request, Response& response)
        {
            return is_refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                                 : httplib::Server::HandlerResponse::Unhandled;
        });
    server_.set_error_handler(
        [](const Request&, Response& response)
        {
            if (response.body.empty())
            {
                answer(response, response.status, "there is nothing here");
            }
        });
}

LoopbackServer::~LoopbackServer()
{
    if (!listener_.joinable())
    {
        return;
    }
    while (!server_.is_running() && !has_ended_) // stop() is lost on one that has not begun.
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    server_.stop();
    listener_.join();
}

std::optional<Refusal> LoopbackServer::start(std::uint16_t port, const char* option)
{
    // The library's own choice lets a second server take the same port and share its visitors.
    server_.set_socket_options(
        [](socket_t socket)
        {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
        });
    errno = 0;
    const int got = port != 0 && server_.bind_to_port("127.0.0.1", port)
                        ? port
                        : (port == 0 ? server_.bind_to_any_port("127.0.0.1") : -1);
    if (got <= 0)
    {
        return Refusal{fmt::format("port {} of 127.0.0.1 can't be had: {}; give another with {}, "
                                   "0 for any",
                                   port, std::strerror(errno), option)};
    }
    port_ = static_cast<std::uint16_t>(got);
    listener_ = std::thread(
        [this]
        {
            server_.listen_after_bind();
            has_ended_ = true;
        });
    return std::nullopt;
}

bool LoopbackServer::is_ours(const std::string& authority) const
{
    return authority == fmt::format("127.0.0.1:{}", port_) ||
           authority == fmt::format("localhost:{}", port_);
}

/// Nobody else's pages may ask, nor names that a stranger has pointed at this machine.
bool LoopbackServer::is_refused(const httplib::Request& request, httplib::Response& response)
{
    if (request.method != "GET")
    {
        response.set_header("Allow", "GET");
        answer(response, 405, "only GET");
        return true;
    }
    if (request.get_header_value_count("Host") != 1 || !is_ours(request.get_header_value("Host")))
    {
        answer(response, 421, fmt::format("this is 127.0.0.1:{} and no other host", port_));
        return true;
    }
    const std::string origin = request.get_header_value("Origin");
    constexpr std::string_view scheme = "http://";
    if (request.has_header("Origin") &&
        (!origin.starts_with(scheme) || !is_ours(origin.substr(scheme.size()))))
    {
        answer(response, 403, "not for other pages");
        return true;
    }
    return false;
}

} // namespace tactus::web
