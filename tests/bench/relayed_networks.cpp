// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/relayed_networks.hpp"

#include "tests/bench/bench_row.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tactus::bench
{

namespace
{

using Json = nlohmann::json;

NetworkEnd end_of(const Json& ready, const char* name)
{
    return {fmt::format("/proc/{}/fd/{}", ready["pid"].get<int>(), ready[name]["fd"].get<int>()),
            ready[name]["dds"].get<std::string>()};
}

} // namespace

RelayedNetworks RelayedNetworks::make(const LinkManner& manner, const std::filesystem::path& folder)
{
    ProgramSetup setup;
    setup.words = {program_path("network_relay"),
                   "--delay-ms",
                   fmt::format("{}", manner.delay_ms),
                   "--loss",
                   fmt::format("{}", manner.loss),
                   "--seed",
                   fmt::format("{}", kSeed)};
    setup.output = folder / "relay.log";
    setup.is_asked = true;
    auto relay = Program::start(setup);
    RelayedNetworks networks(std::move(relay));
    const auto ready = networks.relay_.ask("");
    const Json facts = Json::parse(ready);
    networks.server_ = end_of(facts, "server");
    networks.controller_ = end_of(facts, "controller");
    return networks;
}

LinkTraffic RelayedNetworks::traffic()
{
    const auto answer = relay_.ask("count");
    const Json counted = Json::parse(answer);
    LinkTraffic traffic;
    for (const char* direction : {"to_server", "to_controller"})
    {
        traffic.payload_bytes += counted[direction]["udp_payload_bytes"].get<std::uint64_t>();
        traffic.datagrams += counted[direction]["udp_datagrams"].get<std::uint64_t>();
    }
    return traffic;
}

} // namespace tactus::bench
