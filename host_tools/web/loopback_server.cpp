// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/loopback_server.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace tactus::web
{

namespace
{

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

/// Thread pool for cpp-httplib that reports each waiting connection to `connections`.
class Threads final : public httplib::TaskQueue
{
public:
    Threads(std::size_t count, Connections& connections)
        : connections_(connections), threads_(count)
    {
    }

    void enqueue(std::function<void()> serve) override
    {
        connections_.arrive();
        threads_.enqueue(std::move(serve));
    }
    void shutdown() override
    {
        connections_.end_all();
        threads_.shutdown();
    }

private:
    Connections& connections_;
    httplib::ThreadPool threads_;
};

} // namespace

PatientServer::PatientServer(std::size_t threads) : connections_(threads)
{
    // cpp-httplib takes ownership of the result.
    new_task_queue = [this, threads] { return new Threads(threads, connections_); };
}

bool PatientServer::process_and_close_socket(socket_t socket)
{
    connections_.begin(socket);
    PeerStream stream(connections_, socket);
    bool is_closed = false;
    const bool is_served = process_request(stream, true, is_closed, nullptr);
    connections_.end(socket);
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return is_served;
}

void answer(httplib::Response& response, int status, const std::string& text)
{
    response.status = status;
    response.set_content(text + "\n", "text/plain; charset=utf-8");
}

LoopbackServer::LoopbackServer(std::size_t threads) : server_(threads)
{
    using httplib::Request;
    using httplib::Response;
    server_.set_payload_max_length(1);
    server_.set_default_headers(safe_headers());
    server_.set_pre_routing_handler(
        [this](const Request& request, Response& response)
        {
            // Ranges are ignored: a request of 1 KB may name hundreds of ranges, each as large as
            // the whole answer. cpp-httplib continues with this changed request.
            const_cast<Request&>(request).ranges.clear();
            return is_refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                                 : httplib::Server::HandlerResponse::Unhandled;
        });
    server_.set_error_handler(
        [](const Request&, Response& response)
        {
            if (response.body.empty())
            {
                answer(response, response.status, "not found");
            }
        });
}

LoopbackServer::~LoopbackServer()
{
    if (!listener_.joinable())
    {
        return;
    }
    // stop() has no effect on a server that does not run yet.
    while (!server_.is_running() && !has_ended_)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    server_.stop();
    listener_.join();
}

std::optional<Refusal> LoopbackServer::start(std::uint16_t port, const char* option)
{
    // cpp-httplib's default options let a second server take connections of the same port.
    socket_t listening = -1;
    server_.set_socket_options(
        [&listening](socket_t socket)
        {
            listening = socket;
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
        });
    errno = 0;
    const int got = port != 0 && server_.bind_to_port("127.0.0.1", port)
                        ? port
                        : (port == 0 ? server_.bind_to_any_port("127.0.0.1") : -1);
    if (got <= 0)
    {
        return Refusal{fmt::format(
            "port {} of 127.0.0.1 is not available: {}; set another with {}, 0 for any free port",
            port, std::strerror(errno), option)};
    }
    // cpp-httplib's backlog is 5: the sixth connection of a burst would wait for seconds.
    ::listen(listening, SOMAXCONN);
#ifdef TCP_DEFER_ACCEPT // Linux: a silent connection gets no thread.
    const int seconds = static_cast<int>(PeerStream::kRequestPatience.count());
    ::setsockopt(listening, IPPROTO_TCP, TCP_DEFER_ACCEPT, &seconds, sizeof(seconds));
#endif
    server_.set_socket_options(nullptr);
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

/// Refuses methods other than GET, other host names for this machine, and other pages.
bool LoopbackServer::is_refused(const httplib::Request& request, httplib::Response& response)
{
    if (request.method != "GET")
    {
        response.set_header("Allow", "GET");
        answer(response, 405, "only GET is allowed");
        return true;
    }
    if (request.get_header_value_count("Host") != 1 || !is_ours(request.get_header_value("Host")))
    {
        answer(response, 421,
               fmt::format("the Host header must name this server, 127.0.0.1:{}", port_));
        return true;
    }
    const std::string origin = request.get_header_value("Origin");
    constexpr std::string_view scheme = "http://";
    if (request.has_header("Origin") &&
        (!origin.starts_with(scheme) || !is_ours(origin.substr(scheme.size()))))
    {
        answer(response, 403, "requests from other pages are refused");
        return true;
    }
    return false;
}

} // namespace tactus::web
