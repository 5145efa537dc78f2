// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/hostile/raw_rtps.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <bit>
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

constexpr std::uint64_t kMuchLater = std::uint64_t{1} << 40U;

/// Appends a number, little-endian.
template <typename Number>
void append(RawRtps::Datagram& datagram, Number number)
{
    for (std::size_t i = 0; i < sizeof(number); ++i)
    {
        datagram.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> 8 * i));
    }
}

/// Appends a sequence number, high half first.
void append_sequence(RawRtps::Datagram& datagram, std::uint64_t sequence)
{
    append(datagram, static_cast<std::uint32_t>(sequence >> 32U));
    append(datagram, static_cast<std::uint32_t>(sequence));
}

/// Message up to the identity of the writer: a submessage of that kind with `bytes` after its own
/// header, to all of its readers.
RawRtps::Datagram begin_message(const RawRtps::Guid& writer, std::uint8_t kind, std::uint8_t flags,
                                std::uint16_t bytes)
{
    RawRtps::Datagram datagram{'R', 'T', 'P', 'S', 2, 1, 1, 16};
    datagram.insert(datagram.end(), writer.begin(), writer.begin() + 12);
    datagram.insert(datagram.end(), {kind, flags});
    append(datagram, bytes);
    if (kind == 0x15) // No further flags, and no inline QoS.
    {
        append(datagram, std::uint16_t{0});
        append(datagram, std::uint16_t{16});
    }
    append(datagram, std::uint32_t{0});
    datagram.insert(datagram.end(), writer.begin() + 12, writer.end());
    return datagram;
}

} // namespace

RawRtps::Datagram RawRtps::later_motion(const Guid& writer, std::uint64_t server_epoch)
{
    constexpr std::array<double, 8> kPlace{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    constexpr std::uint16_t kPayload = 4 + 8 + 8 + 8 + 4 + 4 + 4 + 4 + 64;
    Datagram datagram = begin_message(writer, 0x15, 0x05, 20 + kPayload);
    append_sequence(datagram, kMuchLater);
    datagram.insert(datagram.end(), {0, 1, 0, 0}); // Little-endian CDR.
    append(datagram, server_epoch);
    append(datagram, ~std::uint64_t{0}); // Serial number, the largest.
    append(datagram, std::uint64_t{1});  // Time.
    append(datagram, std::uint32_t{1});  // Number of objects.
    append(datagram, std::uint32_t{1});  // Number of moved objects.
    append(datagram, std::uint32_t{0});  // Number of the object.
    append(datagram, std::uint32_t{1});  // Generation of the object.
    for (const double value : kPlace)
    {
        append(datagram, std::bit_cast<std::uint64_t>(value));
    }
    return datagram;
}

RawRtps::Datagram RawRtps::later_heartbeat(const Guid& writer, std::uint64_t /*server_epoch*/)
{
    static std::uint32_t count = 1'000'000;
    Datagram datagram = begin_message(writer, 0x07, 0x01, 28);
    append_sequence(datagram, kMuchLater);
    append_sequence(datagram, kMuchLater);
    append(datagram, ++count);
    return datagram;
}

RawRtps::Datagram RawRtps::another_participant()
{
    // Writer of participant announcements.
    constexpr std::array<std::uint8_t, 4> kFinder{0, 1, 0, 0xC2};
    constexpr std::array<std::uint8_t, 4> kLease{2, 0, 8, 0};
    const auto holds = [](const Datagram& heard, const auto& bytes)
    { return std::search(heard.begin(), heard.end(), bytes.begin(), bytes.end()) != heard.end(); };
    const auto model =
        std::ranges::find_if(heard_, [&](const Datagram& heard)
                             { return holds(heard, kFinder) && holds(heard, kLease); });
    if (model == heard_.end())
    {
        std::fprintf(stderr, "attacker: heard no participant\n");
        std::exit(2);
    }
    Datagram datagram = *model;
    const std::vector<std::uint8_t> old(datagram.begin() + kPrefixAt,
                                        datagram.begin() + kPrefixAt + 12);
    std::array<std::uint8_t, 12> prefix{};
    std::ranges::generate(prefix, [this] { return static_cast<std::uint8_t>(random_()); });
    prefix[0] = 1; // The first byte is Cyclone's without security.
    for (auto at = datagram.begin();
         (at = std::search(at, datagram.end(), old.begin(), old.end())) != datagram.end();)
    {
        at = std::ranges::copy(prefix, at).out;
    }
    const auto lease =
        std::search(datagram.begin(), datagram.end(), kLease.begin(), kLease.end()) + 4;
    std::fill(lease, lease + 8, std::uint8_t{0xFF});
    lease[3] = 0x7F;
    return datagram;
}

/// Binds the last discovery port; participants take them from the first one on.
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
