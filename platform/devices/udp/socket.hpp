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

/// A datagram socket that never waits but in wait(). send() may be called from any thread, the rest
/// from one.
class Socket
{
public:
    static constexpr int kPortMin = 1'024;
    static constexpr int kPortMax = 65'535;

    /// Bound to a numeric IPv4 address of this machine and a port in [kPortMin, kPortMax], or 0 for
    /// any that is free. Refuses others and those that are taken.
    [[nodiscard]] static Result<Socket, Refusal> open(const std::string& address, int port);

    Socket(Socket&& other) noexcept;
    Socket& operator=(Socket&&) = delete;
    ~Socket();

    /// Where it is bound to.
    [[nodiscard]] const Endpoint& endpoint() const noexcept { return endpoint_; }

    /// Until something is there to be received, or the time is over.
    void wait(Duration time) const noexcept;

    struct Received
    {
        std::size_t bytes{0}; ///< As many as it had, or the buffer has room for.
        Endpoint from;
    };
    /// None when nothing is there.
    [[nodiscard]] std::optional<Received> receive(std::span<std::byte> buffer) const noexcept;

    /// False when the system refused it.
    [[nodiscard]] bool send(std::span<const std::byte> bytes, const Endpoint& to) const noexcept;

private:
    Socket(int descriptor, const Endpoint& endpoint) noexcept
        : descriptor_(descriptor), endpoint_(endpoint)
    {
    }

    int descriptor_;
    Endpoint endpoint_;
};

/// "127.0.0.1:48500"
[[nodiscard]] std::string text_of(const Endpoint& endpoint);

} // namespace tactus::udp
