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

/// The connections of a server: those that have a thread, and how many have none yet. All come from
/// this machine's loopback, so no address tells one peer from another. Instead the one that keeps
/// its thread waiting longest gives it up when a connection comes and all threads are taken: no
/// number of silent or slow peers keeps an honest one out. Any thread.
class Connections
{
public:
    using Clock = std::chrono::steady_clock;

    explicit Connections(std::size_t threads) : threads_(threads) {}

    /// A connection waits for a thread.
    void arrive();
    /// A connection has got its thread.
    void begin(int socket);
    /// Its socket is to be closed by the caller.
    void end(int socket);
    /// All peers have lost their patience: the server ends.
    void end_all();

    /// Waits for the peer: until its socket is ready for these events of poll(). False at the
    /// deadline, or when the connection has given up its thread.
    [[nodiscard]] bool wait(int socket, short events, Clock::time_point deadline);

private:
    struct Served
    {
        int socket{-1};
        std::optional<Clock::time_point> waits_since; ///< None while its thread works for it.
    };

    void end_longest_wait();
    [[nodiscard]] Served& served(int socket);

    std::mutex mutex_;
    const std::size_t threads_;
    std::size_t queued_{0}; ///< Connections without a thread.
    bool is_ended_{false};
    std::vector<Served> served_;
};

/// A connection as the library reads and writes it: the whole request within kRequestPatience and
/// kRequestMax, and an answer within kAnswerPatience of the last part that was taken as a whole.
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
    std::optional<Clock::time_point> answer_end_; ///< Of the part that is being taken.
    std::array<char, 4'096> buffer_{};
    std::size_t begin_{0}; ///< The first byte of the buffer that is not read yet.
    std::size_t end_{0};
    std::size_t received_{0};
};

} // namespace tactus::web
