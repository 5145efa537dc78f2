// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/program.hpp"

#include <cstdint>
#include <string>

namespace tactus::bench
{

/// Properties of the link between two networks, each way.
struct LinkManner
{
    double delay_ms{10.0};
    double loss{0.0};
};

/// One end: the network of a program and its DDS configuration. Default: this machine's loopback
/// interface, which our programs configure themselves.
struct NetworkEnd
{
    std::string network; ///< ProgramSetup::network.
    std::string dds_uri;
};

/// UDP payload through the relay, both directions together.
struct LinkTraffic
{
    std::uint64_t payload_bytes{0};
    std::uint64_t datagrams{0};
};

/// Two networks and the relay between them (tests/relay). Requires root and /dev/net/tun.
class RelayedNetworks
{
public:
    [[nodiscard]] static RelayedNetworks make(const LinkManner& manner,
                                              const std::filesystem::path& folder);

    [[nodiscard]] const NetworkEnd& server() const { return server_; }
    [[nodiscard]] const NetworkEnd& controller() const { return controller_; }
    [[nodiscard]] LinkTraffic traffic();

private:
    explicit RelayedNetworks(Program relay) : relay_(std::move(relay)) {}

    Program relay_;
    NetworkEnd server_;
    NetworkEnd controller_;
};

} // namespace tactus::bench
