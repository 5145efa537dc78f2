// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/session.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace tactus::udp
{

/// A UDP socket that blocks only in wait(). send() may be called from any thread, the rest from
/// one.
class Socket
{
public:
    static constexpr int kPortMin = 1'024;
    static constexpr int kPortMax = 65'535;

    /// Opens a socket bound to a numeric IPv4 address of this machine and a port in [kPortMin,
    /// kPortMax]; port 0 selects a free one. Refuses other values and ports in use.
    [[nodiscard]] static Result<Socket, Refusal> open(const std::string& address, int port);

    Socket(Socket&& other) noexcept;
    Socket& operator=(Socket&&) = delete;
    ~Socket();

    /// Bound address and port.
    [[nodiscard]] const Endpoint& endpoint() const noexcept { return endpoint_; }

    /// Waits until a datagram arrives, for `time` at most.
    void wait(Duration time) const noexcept;

    struct Received
    {
        std::size_t bytes{0}; ///< Size of the datagram, cut to the buffer.
        Endpoint from;
    };
    /// Takes the next datagram from the system's queue; none if the queue is empty.
    [[nodiscard]] std::optional<Received> receive(std::span<std::byte> buffer) const noexcept;

    /// Sends a datagram; false if the system refused it.
    [[nodiscard]] bool send(std::span<const std::byte> bytes, const Endpoint& to) const noexcept;

private:
    Socket(int descriptor, const Endpoint& endpoint) noexcept
        : descriptor_(descriptor), endpoint_(endpoint)
    {
    }

    int descriptor_;
    Endpoint endpoint_;
};

/// Text such as "127.0.0.1:48500".
[[nodiscard]] std::string text_of(const Endpoint& endpoint);

} // namespace tactus::udp
