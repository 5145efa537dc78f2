// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/domain.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/program_log.hpp"
#include "transport/dds/key_folder.hpp"
#include "transport/log.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <netinet/in.h>
#include <sstream>
#include <sys/socket.h>
#include <system_error>
#include <vector>

namespace tactus::dds
{

namespace
{

#ifdef SO_BINDTODEVICE

/// True if the socket receives datagrams from every interface.
bool receives_from_everywhere(int descriptor)
{
    int kind = 0;
    socklen_t size = sizeof(kind);
    sockaddr_in address{};
    socklen_t address_size = sizeof(address);
    return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) == 0 && kind == SOCK_DGRAM &&
           ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &address_size) == 0 &&
           address.sin_family == AF_INET && address.sin_port != 0 &&
           address.sin_addr.s_addr == htonl(INADDR_ANY);
}

/// Descriptors of this process's sockets that receive from every interface, ascending.
std::vector<int> open_to_everywhere()
{
    std::vector<int> found;
    std::error_code ignored; // A descriptor closed meanwhile is skipped.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored))
    {
        const std::string name = entry.path().filename().string();
        int descriptor = -1;
        std::from_chars(name.data(), name.data() + name.size(), descriptor);
        if (receives_from_everywhere(descriptor))
        {
            found.push_back(descriptor);
        }
    }
    std::ranges::sort(found);
    return found;
}

#endif

/// Restricts sockets to loopback: Cyclone 0.10 binds its receiving sockets to all interfaces,
/// regardless of its configuration. Calls `open_sockets`, then binds each UDP socket that it opened
/// for all interfaces to the loopback device. Returns the reason if that fails. No other thread may
/// open such sockets meanwhile. Has no effect on systems other than Linux.
std::optional<std::string> opened_on_loopback(const std::function<void()>& open_sockets)
{
#ifdef SO_BINDTODEVICE
    constexpr std::string_view kLoopback = "lo";
    const std::vector<int> before = open_to_everywhere();
    open_sockets();
    for (const int descriptor : open_to_everywhere())
    {
        if (!std::ranges::binary_search(before, descriptor) &&
            ::setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kLoopback.data(),
                         static_cast<socklen_t>(kLoopback.size())) != 0)
        {
            return std::strerror(errno);
        }
    }
#else
    open_sockets();
#endif
    return std::nullopt;
}

/// Default configuration; the fields are ParticipantIndex and a peer. Servers have the well-known
/// ports of indices 0 to 9; controllers have arbitrary ports and search the well-known ones, so
/// they do not discover each other: with 64 of them discovery took a minute. A lost sample may take
/// 100 ms to repeat, since on loopback only overflow loses samples and frequent heartbeats add to
/// it. One receive thread, so that every thread has a known name and thus a stack size.
constexpr const char* kConfiguration = R"(<CycloneDDS><Domain id="any">
<General>
  <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
  <AllowMulticast>false</AllowMulticast>
</General>
<Discovery>
  <ParticipantIndex>{}</ParticipantIndex>
  <MaxAutoParticipantIndex>10</MaxAutoParticipantIndex>
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
  <Thread name="fsm"><StackSize>512 kB</StackSize></Thread>
  <Thread name="gc"><StackSize>256 kB</StackSize></Thread>
</Threads>
</Domain></CycloneDDS>)";
/// Peers: the ports of all servers on this machine, or the discard port for none. An empty list
/// would mean the former.
constexpr const char* kLooksForServers = "127.0.0.1";
constexpr const char* kLooksNowhere = "127.0.0.1:9";

/// UDP ports of discovery by the RTPS specification: the first port of domain 0, the ports of each
/// domain, and those of its ten servers.
constexpr std::uint32_t kFirstPort = 7'410;
constexpr std::uint32_t kPortsOfDomain = 250;
constexpr std::uint32_t kPortsOfServers = 20;

/// Log of Cyclone's messages, one for the process, at a limited rate: a link that is down causes
/// 100 lines a second.
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
        const std::string text = printable(raw, 1'000); // Messages may quote network data.
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
    Party party{Party::server}; ///< Role with which the domain was created.
};

/// Entity of the domain with the default configuration, shared by the process: Cyclone allows one
/// configuration for each id. Null for a server if it was created for a controller.
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
        const char* peers = party == Party::server ? kLooksNowhere : kLooksForServers;
        const std::string configuration = fmt::format(kConfiguration, index, peers);
        const auto fault = opened_on_loopback(
            [&]
            { domain = std::make_shared<Entity>(dds_create_domain(id, configuration.c_str())); });
        if (fault)
        {
            log_message(LogLevel::warning, "dds",
                        "sockets receive from every interface, not from loopback alone: " + *fault);
        }
        known = {domain, party};
    }
    return known.party == Party::controller && party != Party::controller ? nullptr : domain;
}

std::string configuration_of_user()
{
    const char* uri = std::getenv("CYCLONEDDS_URI");
    return uri == nullptr ? "" : uri;
}

bool has_configuration_of_user()
{
    return !configuration_of_user().empty();
}

Refusal join_error(std::uint32_t id, std::int32_t code)
{
    const std::string reason = MessageSink::instance().last();
    const bool is_configured = has_configuration_of_user();
    const bool has_no_port = reason.find("free participant index") != std::string::npos;
    std::string more = is_configured ? " (configured by CYCLONEDDS_URI)" : "";
    if (has_no_port && !is_configured)
    {
        const std::uint32_t first = kFirstPort + kPortsOfDomain * id;
        more = fmt::format(" (other programs use its UDP ports {} to {}; 'ss -ulpn' lists them)",
                           first, first + kPortsOfServers - 1);
    }
    return {fmt::format("DDS domain {} cannot be joined: {}{}", id,
                        reason.empty() ? dds_strretcode(code) : reason, more)};
}

/// Time before the end of the keys with a warning at the start.
constexpr std::time_t kDay_s = 24 * 3'600;
constexpr std::time_t kSoon_s = 30 * kDay_s;

/// The keys of the choice; none if the domain is joined without.
Result<std::optional<KeyFolder>, Refusal> take_keys(const DomainChoice& choice)
{
    const NetworkSecurity& security = choice.security;
    if (security.keys.empty())
    {
        if (security.is_required)
        {
            return Refusal{"--require-security: no keys are given; name their folder with "
                           "--security DIR"};
        }
        if (!security.is_plain && is_open_to_network(configuration_of_user()))
        {
            return Refusal{
                "CYCLONEDDS_URI names a network, and every program there can take part: use "
                "--security DIR for keys, or --plain to continue without"};
        }
        return std::optional<KeyFolder>();
    }
    const std::time_t now = std::time(nullptr);
    auto keys = read_key_folder(security.keys, choice.id, now);
    if (!keys)
    {
        return keys.error();
    }
    if (const std::time_t left_s = keys.value().valid_until - now; left_s < kSoon_s)
    {
        log_message(LogLevel::warning, "dds",
                    fmt::format("the keys of '{}' end in {}: renew them with tactus-keys",
                                keys.value().name,
                                counted(static_cast<std::uint64_t>(left_s / kDay_s), "day")));
    }
    return std::optional(std::move(keys).value());
}

Entity make_participant(std::uint32_t id, const std::optional<KeyFolder>& keys)
{
    const std::unique_ptr<dds_qos, void (*)(dds_qos*)> qos(dds_create_qos(), dds_delete_qos);
    if (keys)
    {
        protect(qos.get(), *keys);
    }
    return Entity(dds_create_participant(id, qos.get(), nullptr));
}

} // namespace

Result<Domain, Refusal> Domain::join(const DomainChoice& choice, Party party)
{
    const std::uint32_t id = choice.id;
    if (id > kMaxDomain)
    {
        return Refusal{fmt::format("DDS domain {} is not in 0 to {}", id, kMaxDomain)};
    }
    const auto keys = take_keys(choice);
    if (!keys)
    {
        return keys.error();
    }
    dds_set_log_sink(&MessageSink::on_message, nullptr);
    Domain domain;
    domain.id_ = id;
    if (!has_configuration_of_user())
    {
        domain.configuration_ = configured_domain(id, party);
        if (domain.configuration_ == nullptr)
        {
            return Refusal{fmt::format("DDS domain {} was joined by a controller of this process: "
                                       "its server must join first, or no program finds it",
                                       id)};
        }
        if (!domain.configuration_->is_valid())
        {
            return join_error(id, domain.configuration_->get());
        }
    }
    domain.participant_ = make_participant(id, keys.value());
    domain.certificate_ = keys.value() ? keys.value()->name : "";
    if (!domain.participant_.is_valid())
    {
        return join_error(id, domain.participant_.get());
    }
    domain.participants_ = std::make_unique<Participants>(domain.participant_.get());
    return domain;
}

void Domain::be_silent(std::chrono::seconds length) const
{
    log_message(LogLevel::warning, "dds",
                fmt::format("a server is present on domain {}, but its handshake does not end: "
                            "silent for {} s, so that both sides begin again",
                            id_, length.count()));
    constexpr bool kDeaf = true;
    constexpr bool kMute = true;
    dds_domain_set_deafmute(participant_.get(), kDeaf, kMute,
                            std::chrono::nanoseconds(length).count());
}

std::set<std::uint32_t> domains_in(std::string_view udp_sockets)
{
    std::set<std::uint32_t> domains;
    std::istringstream lines{std::string(udp_sockets)};
    std::string line;
    std::getline(lines, line); // Column names.
    while (std::getline(lines, line))
    {
        std::istringstream words(line);
        std::string number;
        std::string local; // ADDRESS:PORT in hexadecimal digits.
        words >> number >> local;
        const std::size_t digits = local.rfind(':') + 1;
        std::uint32_t port = 0;
        std::from_chars(local.data() + digits, local.data() + local.size(), port, 16);
        const std::uint32_t above = port - std::min(port, kFirstPort);
        if (port >= kFirstPort && above % kPortsOfDomain < kPortsOfServers &&
            above / kPortsOfDomain <= kMaxDomain)
        {
            domains.insert(above / kPortsOfDomain);
        }
    }
    return domains;
}

std::optional<std::string> why_unheard(std::uint32_t domain)
{
    std::ifstream file("/proc/net/udp"); // Missing outside of Linux: no domain is then found.
    std::set<std::uint32_t> domains =
        domains_in(std::string(std::istreambuf_iterator<char>(file), {}));
    domains.erase(domain);
    std::string text = has_configuration_of_user()
                           ? ""
                           : "CYCLONEDDS_URI is not set, so only this machine is reached";
    if (!domains.empty())
    {
        text += fmt::format("{}programs of this machine are on domain {}", text.empty() ? "" : "; ",
                            fmt::join(domains, ", "));
    }
    return text.empty() ? std::nullopt : std::optional(text);
}

} // namespace tactus::dds
