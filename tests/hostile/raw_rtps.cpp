// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/hostile/raw_rtps.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cstdio>
#include <cstdlib>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace
{

constexpr std::size_t kHeaderBytes = 20; // Magic, version, vendor, prefix of the participant.
constexpr std::ptrdiff_t kPrefixAt = 8;
constexpr std::size_t kHeardMost = 256;

sockaddr_in loopback(std::uint16_t port)
{
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    return address;
}

} // namespace

/// The last of the ports where participants are looked for; they are taken from the first one on.
RawRtps::RawRtps(std::uint32_t domain) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0))
{
    const sockaddr_in own = loopback(static_cast<std::uint16_t>(7'400 + 250 * domain + 10 + 2 * 8));
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) != 0)
    {
        std::perror("attacker: bind");
        std::exit(2);
    }
}

RawRtps::~RawRtps()
{
    ::close(socket_);
}

void RawRtps::listen()
{
    std::array<std::uint8_t, 65'536> bytes{};
    for (;;)
    {
        const auto size = ::recv(socket_, bytes.data(), bytes.size(), 0);
        if (size <= 0)
        {
            return;
        }
        if (static_cast<std::size_t>(size) > kHeaderBytes && heard_.size() < kHeardMost)
        {
            heard_.emplace_back(bytes.begin(), bytes.begin() + size);
        }
    }
}

RawRtps::Datagram RawRtps::any_heard()
{
    Datagram datagram = heard_[below(heard_.size())];
    if (below(2) == 0)
    {
        std::ranges::copy(prefix_, datagram.begin() + kPrefixAt);
    }
    return datagram;
}

RawRtps::Datagram RawRtps::any_garbled()
{
    Datagram datagram = any_heard();
    for (std::size_t changes = 1 + below(8); changes > 0; --changes)
    {
        datagram[4 + below(datagram.size() - 4)] = static_cast<std::uint8_t>(random_());
    }
    const std::size_t kind = below(8);
    if (kind == 0)
    {
        datagram.resize(1 + below(datagram.size()));
    }
    else if (kind == 1)
    {
        datagram.resize(datagram.size() + below(2'000), 0xFF);
    }
    return datagram;
}

RawRtps::Datagram RawRtps::nonsense()
{
    Datagram datagram(kHeaderBytes + below(1'400));
    std::ranges::generate(datagram, [this] { return static_cast<std::uint8_t>(random_()); });
    constexpr std::array<std::uint8_t, 8> kStart{'R', 'T', 'P', 'S', 2, 1, 1, 16};
    std::ranges::copy(kStart, datagram.begin());
    return datagram;
}

void RawRtps::send(const Datagram& datagram, std::uint16_t port) const
{
    const sockaddr_in to = loopback(port);
    static_cast<void>(::sendto(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT,
                               reinterpret_cast<const sockaddr*>(&to), sizeof(to)));
}
