// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace tactus::test
{

/// Connection to a server of this machine, byte by byte.
struct Connection
{
    explicit Connection(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0))
    {
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
                  0);
    }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    ~Connection() { ::close(socket_); }

    void send(const std::string& text) const
    {
        // The peer may have closed already.
        static_cast<void>(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL));
    }
    /// True if the peer has closed; earlier data are dropped.
    [[nodiscard]] bool is_closed() const
    {
        char bytes[4096];
        ssize_t count = 1;
        while (count > 0)
        {
            count = ::recv(socket_, static_cast<char*>(bytes), sizeof(bytes), MSG_DONTWAIT);
        }
        return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK);
    }
    void end_sending() const { ::shutdown(socket_, SHUT_WR); }
    /// Reads until the peer closes or sends `until`.
    std::string read(const std::string& until = "")
    {
        std::string all;
        char bytes[4096];
        for (ssize_t count = 1; count > 0;)
        {
            count = ::recv(socket_, static_cast<char*>(bytes), sizeof(bytes), 0);
            all.append(static_cast<char*>(bytes), count > 0 ? static_cast<std::size_t>(count) : 0);
            if (!until.empty() && all.find(until) != std::string::npos)
            {
                break;
            }
        }
        return all;
    }

private:
    int socket_;
};

/// Opens silent connections; `ask` then returns the status of a request, which is answered while
/// some of them still exist: it has not waited for all timeouts. A machine that stops for longer
/// than the timeout gets another try.
template <typename Ask>
void expect_answer_among_silent(std::uint16_t port, std::size_t count, const Ask& ask)
{
    bool is_one_left = false;
    for (int i = 0; i < 10 && !is_one_left; ++i)
    {
        std::vector<std::unique_ptr<Connection>> silent;
        for (std::size_t one = 0; one < count; ++one)
        {
            silent.push_back(std::make_unique<Connection>(port));
        }
        EXPECT_EQ(ask(), 200);
        is_one_left =
            std::ranges::any_of(silent, [](const auto& one) { return !one->is_closed(); });
    }
    EXPECT_TRUE(is_one_left);
}

} // namespace tactus::test
