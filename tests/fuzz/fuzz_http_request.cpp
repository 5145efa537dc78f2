// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is what a peer sends to the server of pages and metrics before it ends its side of the
/// connection. Requests with the Host name 127.0.0.1:0 are answered.
#include "host_tools/web/loopback_server.hpp"
#include "host_tools/web/peer_stream.hpp"
#include "tests/fuzz/law.hpp"

#include <algorithm>
#include <array>
#include <httplib.h>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>

namespace tactus::fuzz
{

namespace
{

/// More than the server takes of one request.
constexpr std::size_t kInputMost = web::PeerStream::kRequestMax + 1'024;
constexpr std::size_t kAnswerMost = 4'096;

/// Gives access to a protected member of each server.
struct Serving : httplib::Server
{
    static void serve(httplib::Server& server, httplib::Stream& stream)
    {
        bool is_closed = false;
        (server.*(&Serving::process_request))(stream, true, is_closed, nullptr);
    }
};

httplib::Server& local_server()
{
    static web::LoopbackServer local(1); // It never listens: its port is 0.
    static const bool has_answers = []
    {
        local.server().Get("/", [](const httplib::Request&, httplib::Response& response)
                           { web::answer(response, 200, "page"); });
        local.server().Get("/value",
                           [](const httplib::Request& request, httplib::Response& response)
                           {
                               const bool is_known = request.has_param("number");
                               web::answer(response, is_known ? 200 : 404, "value");
                           });
        return true;
    }();
    require(has_answers, "the server has answers");
    return local.server();
}

/// Answer to these bytes, all of which have arrived when the server begins.
std::string answer_to(std::string_view sent)
{
    std::array<int, 2> sockets{};
    require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) == 0,
            "sockets can be made");
    const auto [server, peer] = sockets;
    require(sent.empty() || ::send(peer, sent.data(), sent.size(), MSG_DONTWAIT) ==
                                static_cast<ssize_t>(sent.size()),
            "a request fits into the socket");
    ::shutdown(peer, SHUT_WR);
    {
        web::Connections connections(1);
        connections.arrive();
        connections.begin(server);
        web::PeerStream stream(connections, server);
        Serving::serve(local_server(), stream);
        connections.end(server);
    }
    ::close(server);
    std::string answer;
    std::array<char, kAnswerMost> part{};
    for (ssize_t bytes = 1; bytes > 0;)
    {
        bytes = ::recv(peer, part.data(), part.size(), 0);
        answer.append(part.data(), static_cast<std::size_t>(std::max<ssize_t>(bytes, 0)));
    }
    ::close(peer);
    return answer;
}

void check_answer(std::string_view sent, std::string_view answer)
{
    constexpr std::string_view kDone = "HTTP/1.1 200 ";
    require(answer.empty() || answer.starts_with("HTTP/1.1 "), "an answer is one of HTTP");
    require(answer.size() <= kAnswerMost, "an answer is not larger than its page");
    if (!answer.starts_with(kDone))
    {
        return;
    }
    ++accepted_inputs;
    require(sent.find("GET") != std::string_view::npos, "only GET is answered");
    require(answer.find("Content-Security-Policy: default-src 'self'") != std::string_view::npos &&
                answer.find("X-Content-Type-Options: nosniff") != std::string_view::npos,
            "pages have their safe headers");
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus::fuzz;
    const std::string sent(data, data + std::min(size, kInputMost));
    check_answer(sent, answer_to(sent));
    return 0;
}
