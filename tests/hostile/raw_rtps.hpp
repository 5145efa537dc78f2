// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

/// A stranger without DDS: datagrams on the loopback's ports.
class RawRtps
{
public:
    using Datagram = std::vector<std::uint8_t>;
    using Guid = std::array<std::uint8_t, 16>;

    /// A sample of a host's motion, in the name of that writer, with the sequence number 2^40 and
    /// the largest serial number: object 0 is at the origin.
    [[nodiscard]] static Datagram later_motion(const Guid& writer, std::uint64_t host_epoch);
    /// A heartbeat in its name: all before 2^40 is gone.
    [[nodiscard]] static Datagram later_heartbeat(const Guid& writer, std::uint64_t host_epoch);

    /// Listens at one of the ports where participants of the domain are looked for.
    explicit RawRtps(std::uint32_t domain);
    ~RawRtps();
    RawRtps(const RawRtps&) = delete;
    RawRtps& operator=(const RawRtps&) = delete;

    /// Keeps what participants said there since the last call, some of it.
    void listen();
    /// From now on half of what is made bears the identity of another participant, 12 bytes.
    void speak_as(const std::uint8_t* prefix) { prefix_.assign(prefix, prefix + 12); }
    [[nodiscard]] bool has_heard() const { return !heard_.empty(); }

    /// One of those.
    [[nodiscard]] Datagram any_heard();
    /// With some bytes changed, cut or longer; sizes and magic as they were.
    [[nodiscard]] Datagram any_garbled();
    /// What one said to be found, as one that nobody has seen and whose lease never ends. What it
    /// heard has to have that.
    [[nodiscard]] Datagram another_participant();
    /// A header of RTPS and nonsense.
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
