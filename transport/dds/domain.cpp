// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/domain.hpp"

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

/// Recovery: with Cyclone's defaults one lost sample costs 100 to 200 ms. One receive thread, so
/// that every thread's stack can be set by name. Index range: 100 participants on one machine.
constexpr const char* kConfiguration = R"(<CycloneDDS><Domain id="any">
<General>
  <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
  <AllowMulticast>false</AllowMulticast>
</General>
<Discovery>
  <ParticipantIndex>auto</ParticipantIndex>
  <MaxAutoParticipantIndex>99</MaxAutoParticipantIndex>
  <LeaseDuration>1 s</LeaseDuration>
  <Peers><Peer address="127.0.0.1"/></Peers>
</Discovery>
<Internal>
  <HeartbeatInterval min="2 ms" minsched="2 ms" max="20 ms">5 ms</HeartbeatInterval>
  <NackDelay>1 ms</NackDelay>
  <PreEmptiveAckDelay>2 ms</PreEmptiveAckDelay>
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
        std::string_view text(data->message, data->size);
        text = text.substr(0, text.find_last_not_of('\n') + 1);
        MessageSink& sink = instance();
        const std::lock_guard lock(sink.mutex_);
        if ((data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0 ||
            (data->priority & DDS_LC_CONFIG) != 0)
        {
            sink.last_ = text;
        }
        sink.log_.write("dds: " + std::string(text));
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
                        { std::fprintf(stderr, "%s\n", line.c_str()); }};
};

/// The domain with our configuration; the same one for everybody in the process, since Cyclone
/// allows a domain id to be configured once.
std::shared_ptr<Entity> configured_domain(std::uint32_t id)
{
    static std::mutex mutex;
    static std::map<std::uint32_t, std::weak_ptr<Entity>> domains;
    const std::lock_guard lock(mutex);
    auto domain = domains[id].lock();
    if (!domain)
    {
        domain = std::make_shared<Entity>(dds_create_domain(id, kConfiguration));
        domains[id] = domain;
    }
    return domain;
}

Refusal join_error(std::uint32_t id, std::int32_t code)
{
    const std::string reason = MessageSink::instance().last();
    return {fmt::format(
        "DDS domain {} cannot be joined: {}{}", id, reason.empty() ? dds_strretcode(code) : reason,
        std::getenv("CYCLONEDDS_URI") != nullptr ? " (configured by CYCLONEDDS_URI)" : "")};
}

} // namespace

Result<Domain, Refusal> Domain::join(std::uint32_t id)
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
        domain.configuration_ = configured_domain(id);
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
