// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <httplib.h>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus::web
{

/// Connections of a server: those with a thread, and the number that wait for one. All come from
/// this machine, so addresses do not distinguish peers. If a connection waits for a thread, the one
/// that has waited longest for its peer is closed, so silent or slow peers cannot keep others out.
/// Any thread.
class Connections
{
public:
    using Clock = std::chrono::steady_clock;

    explicit Connections(std::size_t threads) : threads_(threads) {}

    /// Records a connection that waits for a thread.
    void arrive();
    /// Records that a waiting connection got a thread.
    void begin(int socket);
    /// Records that a connection ended; the caller closes its socket.
    void end(int socket);
    /// Closes all connections for input and output, and ends all waits, when the server stops.
    void end_all();

    /// Waits until the peer makes the socket ready for `events` (as of poll()). False at the
    /// deadline, or if the connection was closed in favour of another. The deadline is sooner if
    /// others wait.
    [[nodiscard]] bool wait(int socket, short events, Clock::time_point deadline);

private:
    struct Served
    {
        int socket{-1};
        /// Start of the present wait for the peer; none if there is no wait.
        std::optional<Clock::time_point> waits_since;
    };

    void end_longest_wait();
    [[nodiscard]] Served& served(int socket);

    std::mutex mutex_;
    const std::size_t threads_;
    std::size_t queued_{0}; ///< Number of connections that wait for a thread.
    bool is_ended_{false};
    std::vector<Served> served_;
};

/// Stream of one connection, for cpp-httplib. The whole request must arrive within kRequestPatience
/// and have at most kRequestMax bytes. The peer must take each part of the answer within
/// kAnswerPatience.
class PeerStream final : public httplib::Stream
{
public:
    static constexpr std::chrono::seconds kRequestPatience{2};
    static constexpr std::chrono::seconds kAnswerPatience{30};
    static constexpr std::size_t kRequestMax = 64 * 1'024;

    PeerStream(Connections& connections, int socket) : connections_(connections), socket_(socket) {}

    [[nodiscard]] bool is_readable() const override;
    [[nodiscard]] bool is_writable() const override;
    ssize_t read(char* bytes, std::size_t size) override;
    ssize_t write(const char* bytes, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    [[nodiscard]] socket_t socket() const override { return socket_; }

private:
    using Clock = Connections::Clock;

    [[nodiscard]] bool fill();

    Connections& connections_;
    int socket_;
    Clock::time_point request_end_{Clock::now() + kRequestPatience};
    std::optional<Clock::time_point> answer_end_; ///< Deadline for the part that is being sent.
    std::array<char, 4'096> buffer_{};
    std::size_t begin_{0}; ///< First unread byte of the buffer.
    std::size_t end_{0};
    std::size_t received_{0};
};

} // namespace tactus::web
