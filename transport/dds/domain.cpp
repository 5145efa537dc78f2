// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/domain.hpp"

#include "platform/base/printable.hpp"
#include "platform/base/program_log.hpp"
#include "transport/log.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string_view>

namespace tactus::dds
{

namespace
{

/// Hosts have ports that everybody knows, ten on one machine; controllers have any, and look there.
/// So controllers don't find each other: 64 of them on one machine would do nothing else for a
/// minute. Hosts look nowhere. One lost sample costs up to 100 ms: nothing is lost on loopback but
/// what overflows, and frequent heartbeats make many readers on few processors lose more and more.
/// One receive thread, so that every thread's stack can be set by name.
constexpr const char* kConfiguration = R"(<CycloneDDS><Domain id="any">
<General>
  <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
  <AllowMulticast>false</AllowMulticast>
</General>
<Discovery>
  <ParticipantIndex>{}</ParticipantIndex>
  <MaxAutoParticipantIndex>9</MaxAutoParticipantIndex>
  <LeaseDuration>1 s</LeaseDuration>
  <Peers><Peer address="{}"/></Peers>
</Discovery>
<Internal>
  <NackDelay>10 ms</NackDelay>
  <MultipleReceiveThreads>false</MultipleReceiveThreads>
</Internal>
<Threads>
  <Thread name="recv"><StackSize>512 kB</StackSize></Thread>
  <Thread name="dq.user"><StackSize>512 kB</StackSize></Thread>
  <Thread name="dq.builtins"><StackSize>512 kB</StackSize></Thread>
  <Thread name="tev"><StackSize>512 kB</StackSize></Thread>
  <Thread name="gc"><StackSize>256 kB</StackSize></Thread>
</Threads>
</Domain></CycloneDDS>)";
/// Peers: all ports of hosts; or the one that discards, since without peers Cyclone takes the
/// first.
constexpr const char* kLooksForHosts = "127.0.0.1";
constexpr const char* kLooksNowhere = "127.0.0.1:9";

/// By the specification of RTPS: what the first participant takes of domain 0, how far the domains
/// are apart; and what ten hosts take.
constexpr std::uint32_t kFirstPort = 7'410;
constexpr std::uint32_t kPortsOfDomain = 250;
constexpr std::uint32_t kPortsOfHosts = 20;

/// Cyclone's messages of the whole process. A link that is down prints 100 lines a second.
class MessageSink
{
public:
    static MessageSink& instance()
    {
        static MessageSink sink;
        return sink;
    }

    static void on_message(void* /*unused*/, const dds_log_data_t* data)
    {
        std::string_view raw(data->message, data->size);
        raw = raw.substr(0, raw.find_last_not_of('\n') + 1);
        const std::string text = printable(raw, 1'000); // It quotes what comes over the wire.
        MessageSink& sink = instance();
        const std::lock_guard lock(sink.mutex_);
        if ((data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0 ||
            (data->priority & DDS_LC_CONFIG) != 0)
        {
            sink.last_ = text;
        }
        sink.log_.write(text);
    }

    [[nodiscard]] std::string last()
    {
        const std::lock_guard lock(mutex_);
        return last_;
    }

private:
    std::mutex mutex_;
    std::string last_;
    RateLimitedLog log_{[](const std::string& line)
                        { log_message(LogLevel::warning, "dds", line); }};
};

struct ConfiguredDomain
{
    std::weak_ptr<Entity> entity;
    Party party{Party::host}; ///< It was configured for.
};

/// The domain with our configuration; the same one for everybody in the process, since Cyclone
/// allows a domain id to be configured once. Null: nobody would find a host there.
std::shared_ptr<Entity> configured_domain(std::uint32_t id, Party party)
{
    static std::mutex mutex;
    static std::map<std::uint32_t, ConfiguredDomain> domains;
    const std::lock_guard lock(mutex);
    ConfiguredDomain& known = domains[id];
    auto domain = known.entity.lock();
    if (!domain)
    {
        const char* index = party == Party::controller ? "none" : "auto";
        const char* peers = party == Party::host ? kLooksNowhere : kLooksForHosts;
        const std::string configuration = fmt::format(kConfiguration, index, peers);
        domain = std::make_shared<Entity>(dds_create_domain(id, configuration.c_str()));
        known = {domain, party};
    }
    return known.party == Party::controller && party != Party::controller ? nullptr : domain;
}

Refusal join_error(std::uint32_t id, std::int32_t code)
{
    const std::string reason = MessageSink::instance().last();
    const bool is_configured = std::getenv("CYCLONEDDS_URI") != nullptr;
    const bool has_no_port = reason.find("free participant index") != std::string::npos;
    std::string more = is_configured ? " (configured by CYCLONEDDS_URI)" : "";
    if (has_no_port && !is_configured)
    {
        const std::uint32_t first = kFirstPort + kPortsOfDomain * id;
        more = fmt::format(" (others have its UDP ports {} to {}; 'ss -ulpn' names them)", first,
                           first + kPortsOfHosts - 1);
    }
    return {fmt::format("DDS domain {} cannot be joined: {}{}", id,
                        reason.empty() ? dds_strretcode(code) : reason, more)};
}

} // namespace

Result<Domain, Refusal> Domain::join(std::uint32_t id, Party party)
{
    if (id > kMaxDomain)
    {
        return Refusal{fmt::format("DDS domain {} is not in 0 to {}", id, kMaxDomain)};
    }
    dds_set_log_sink(&MessageSink::on_message, nullptr);
    Domain domain;
    domain.id_ = id;
    const char* uri = std::getenv("CYCLONEDDS_URI");
    if (uri == nullptr || *uri == '\0')
    {
        domain.configuration_ = configured_domain(id, party);
        if (domain.configuration_ == nullptr)
        {
            return Refusal{fmt::format("DDS domain {} was joined by a controller of this process: "
                                       "its host must join first, or nobody finds it",
                                       id)};
        }
        if (!domain.configuration_->is_valid())
        {
            return join_error(id, domain.configuration_->get());
        }
    }
    domain.participant_ = Entity(dds_create_participant(id, nullptr, nullptr));
    if (!domain.participant_.is_valid())
    {
        return join_error(id, domain.participant_.get());
    }
    domain.participants_ = std::make_unique<Participants>(domain.participant_.get());
    return domain;
}

} // namespace tactus::dds
