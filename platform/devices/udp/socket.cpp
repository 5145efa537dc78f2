// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/socket.hpp"

#include "platform/machine/posix/posix_error.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/select.h>
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

/// Makes the descriptor non-blocking, and closed in started programs; false with errno set. Refuses
/// descriptors that don't fit into the fd_set of wait().
// NOLINTBEGIN(cppcoreguidelines-pro-type-vararg): the C library has no other.
bool never_waits(int descriptor) noexcept
{
    if (descriptor >= FD_SETSIZE)
    {
        errno = EMFILE;
        return false;
    }
    return fcntl(descriptor, F_SETFL, O_NONBLOCK) == 0 &&
           fcntl(descriptor, F_SETFD, FD_CLOEXEC) == 0;
}
// NOLINTEND(cppcoreguidelines-pro-type-vararg)

Refusal refuse_binding(const Endpoint& endpoint, int error)
{
    return {"udp device: can't listen on " + text_of(endpoint) + " (" +
            posix::name_of_error(error) + "); use an address of this machine and a free port"};
}

} // namespace

Result<Socket, Refusal> Socket::open(const std::string& address, int port)
{
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1)
    {
        return Refusal{"udp device: '" + address +
                       "' is not a numeric IPv4 address such as 127.0.0.1"};
    }
    if (port != 0 && (port < kPortMin || port > kPortMax))
    {
        return Refusal{"udp device: port " + std::to_string(port) +
                       " is out of range 1024..65535 (0: any free port)"};
    }
    const Endpoint wanted{ntohl(parsed.s_addr), static_cast<std::uint16_t>(port)};
    Socket made(socket(AF_INET, SOCK_DGRAM, 0), wanted);
    if (made.descriptor_ < 0 || !never_waits(made.descriptor_))
    {
        return Refusal{"udp device: the system refused a socket (" + posix::name_of_error(errno) +
                       ")"};
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
    fd_set readable;
    FD_ZERO(&readable);
    FD_SET(descriptor_, &readable);
    const timespec most{time.ns / kSecond_ns, time.ns % kSecond_ns};
    // The result is not needed: receive() finds a datagram. poll() has no times below 1 ms.
    static_cast<void>(pselect(descriptor_ + 1, &readable, nullptr, nullptr, &most, nullptr));
}

std::optional<Socket::Received> Socket::receive(std::span<std::byte> buffer) const noexcept
{
    sockaddr_in from{};
    socklen_t size = sizeof(from);
    const ssize_t bytes = recvfrom(descriptor_, buffer.data(), buffer.size(), 0,
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
