// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

/// Peer without DDS: datagrams on the loopback's ports.
class RawRtps
{
public:
    using Datagram = std::vector<std::uint8_t>;
    using Guid = std::array<std::uint8_t, 16>;

    /// Sample of a server's motion, in the name of that writer, with the sequence number 2^40 and
    /// the largest serial number: object 0 is at the origin.
    [[nodiscard]] static Datagram later_motion(const Guid& writer, std::uint64_t server_epoch);
    /// Heartbeat in the writer's name: all samples before 2^40 are gone.
    [[nodiscard]] static Datagram later_heartbeat(const Guid& writer, std::uint64_t server_epoch);

    /// Listens on one of the domain's discovery ports.
    explicit RawRtps(std::uint32_t domain);
    ~RawRtps();
    RawRtps(const RawRtps&) = delete;
    RawRtps& operator=(const RawRtps&) = delete;

    /// Stores some of the announcements since the last call.
    void listen();
    /// Sets another participant's identity of 12 bytes for half of the datagrams from now on.
    void speak_as(const std::uint8_t* prefix) { prefix_.assign(prefix, prefix + 12); }
    [[nodiscard]] bool has_heard() const { return !heard_.empty(); }

    /// Random stored announcement.
    [[nodiscard]] Datagram any_heard();
    /// Stored announcement with some bytes changed, cut or longer; sizes and magic unchanged.
    [[nodiscard]] Datagram any_garbled();
    /// Stored announcement under a new identity, with an unlimited lease. Requires has_heard().
    [[nodiscard]] Datagram another_participant();
    /// RTPS header with random content.
    [[nodiscard]] Datagram nonsense();

    void send(const Datagram& datagram, std::uint16_t port) const;

private:
    [[nodiscard]] std::size_t below(std::size_t end)
    {
        return static_cast<std::size_t>(random_() % end);
    }

    int socket_;
    std::vector<Datagram> heard_;
    std::vector<std::uint8_t> prefix_;
    std::mt19937_64 random_{20260730};
};
