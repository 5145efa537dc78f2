// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/udp/socket.hpp"

#include "platform/posix/posix_error.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace tactus::udp
{

namespace
{

sockaddr_in to_system(const Endpoint& endpoint) noexcept
{
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(endpoint.port);
    address.sin_addr.s_addr = htonl(endpoint.address);
    return address;
}

Endpoint from_system(const sockaddr_in& address) noexcept
{
    return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

PlatformError refuse_binding(const Endpoint& endpoint, int error)
{
    return {PlatformErrorKind::bad_option,
            "udp device: can't listen on " + text_of(endpoint) + " (" +
                posix::name_of_error(error) +
                "); it must be an address of this machine and a port that nobody uses"};
}

} // namespace

Result<Socket, PlatformError> Socket::open(const std::string& address, int port)
{
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1)
    {
        return PlatformError{PlatformErrorKind::bad_option,
                             "udp device: '" + address +
                                 "' is no numeric IPv4 address such as 127.0.0.1"};
    }
    if (port != 0 && (port < kPortMin || port > kPortMax))
    {
        return PlatformError{PlatformErrorKind::bad_option,
                             "udp device: port " + std::to_string(port) +
                                 " is out of range 1024..65535 (0: any that is free)"};
    }
    const Endpoint wanted{ntohl(parsed.s_addr), static_cast<std::uint16_t>(port)};
    Socket made(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0), wanted);
    if (made.descriptor_ < 0)
    {
        return PlatformError{PlatformErrorKind::system, "udp device: the system gives no socket (" +
                                                            posix::name_of_error(errno) + ")"};
    }
    sockaddr_in bound = to_system(wanted);
    socklen_t size = sizeof(bound);
    if (bind(made.descriptor_, reinterpret_cast<const sockaddr*>(&bound), size) != 0)
    {
        return refuse_binding(wanted, errno);
    }
    if (getsockname(made.descriptor_, reinterpret_cast<sockaddr*>(&bound), &size) != 0)
    {
        return refuse_binding(wanted, errno);
    }
    made.endpoint_ = from_system(bound);
    return made;
}

Socket::Socket(Socket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), endpoint_(other.endpoint_)
{
}

Socket::~Socket()
{
    if (descriptor_ >= 0)
    {
        close(descriptor_);
    }
}

void Socket::wait(Duration time) const noexcept
{
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    pollfd entry{descriptor_, POLLIN, 0};
    const timespec most{time.ns / kSecond_ns, time.ns % kSecond_ns};
    static_cast<void>(ppoll(&entry, 1, &most, nullptr)); // What is there, receive() finds out.
}

std::optional<Socket::Received> Socket::receive(std::span<std::byte> buffer) const noexcept
{
    sockaddr_in from{};
    socklen_t size = sizeof(from);
    const ssize_t bytes = recvfrom(descriptor_, buffer.data(), buffer.size(), MSG_TRUNC,
                                   reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes < 0)
    {
        return std::nullopt;
    }
    return Received{static_cast<std::size_t>(bytes), from_system(from)};
}

bool Socket::send(std::span<const std::byte> bytes, const Endpoint& to) const noexcept
{
    const sockaddr_in address = to_system(to);
    return sendto(descriptor_, bytes.data(), bytes.size(), 0,
                  reinterpret_cast<const sockaddr*>(&address),
                  sizeof(address)) == static_cast<ssize_t>(bytes.size());
}

std::string text_of(const Endpoint& endpoint)
{
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
    {
        text += std::to_string((endpoint.address >> shift) & 0xFFU) + (shift > 0 ? "." : ":");
    }
    return text + std::to_string(endpoint.port);
}

} // namespace tactus::udp
