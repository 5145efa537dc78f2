// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/relayed_networks.hpp"

#include "tests/bench/random.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tactus::bench
{

namespace
{

using Json = nlohmann::json;

/// What docs/protocol.md says of a network; `sizes` are its datagrams'.
std::string dds_configuration(const std::string& interface, const std::string& sizes,
                              const std::string& peers)
{
    return fmt::format(
        R"(<CycloneDDS><Domain id="any"><General><Interfaces><NetworkInterface name="{}" )"
        R"(multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast>{}</General>)"
        R"(<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>99)"
        R"(</MaxAutoParticipantIndex><LeaseDuration>1 s</LeaseDuration><Peers>{}</Peers>)"
        R"(</Discovery><Internal><HeartbeatInterval min="2 ms" minsched="2 ms" max="20 ms">5 ms)"
        R"(</HeartbeatInterval><NackDelay>1 ms</NackDelay><PreEmptiveAckDelay>2 ms)"
        R"(</PreEmptiveAckDelay><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>)"
        R"(</Domain></CycloneDDS>)",
        interface, sizes, peers);
}

NetworkEnd end_of(const Json& ready, const std::string& own, const std::string& other)
{
    const auto peer = [&](const std::string& end)
    {
        const auto address = ready[end]["address"].get<std::string>(); // With its mask's length.
        return fmt::format(R"(<Peer address="{}"/>)", address.substr(0, address.find('/')));
    };
    return {fmt::format("/proc/{}/fd/{}", ready["pid"].get<int>(), ready[own]["fd"].get<int>()),
            dds_configuration(ready[own]["interface"].get<std::string>(),
                              "<MaxMessageSize>1400B</MaxMessageSize>"
                              "<FragmentSize>1300B</FragmentSize>",
                              peer(own) + peer(other))};
}

} // namespace

NetworkEnd loopback_end()
{
    return {"", dds_configuration("lo", "", R"(<Peer address="127.0.0.1"/>)")};
}

Result<RelayedNetworks, SceneError> RelayedNetworks::make(const LinkManner& manner,
                                                          const std::filesystem::path& folder)
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
    if (!relay)
    {
        return relay.error();
    }
    RelayedNetworks networks(std::move(relay).value());
    const auto ready = networks.relay_.ask("");
    if (!ready)
    {
        return ready.error();
    }
    const Json facts = Json::parse(ready.value());
    networks.host_ = end_of(facts, "host", "controller");
    networks.controller_ = end_of(facts, "controller", "host");
    return networks;
}

Result<LinkTraffic, SceneError> RelayedNetworks::traffic()
{
    const auto answer = relay_.ask("count");
    if (!answer)
    {
        return answer.error();
    }
    const Json counted = Json::parse(answer.value());
    LinkTraffic traffic;
    for (const char* direction : {"to_host", "to_controller"})
    {
        traffic.payload_bytes += counted[direction]["udp_payload_bytes"].get<std::uint64_t>();
        traffic.datagrams += counted[direction]["udp_datagrams"].get<std::uint64_t>();
    }
    return traffic;
}

} // namespace tactus::bench
