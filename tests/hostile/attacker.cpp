// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// attacker DOMAIN SECONDS ATTACK[@MICROSECONDS] [PORT...]: unauthenticated peer on the domain of a
/// model server and a controller. It uses only the topics' types; attacks rtps_* use only the
/// others' UDP ports. Waits until it has seen both, for at most ATTACKER_PATIENCE_S, then repeats
/// one action, with its own or the given pause (0: none), at least SECONDS long and as often as the
/// attack needs, and prints the number. Exits 2 if it saw no peer.

#include "transport/content_hash.hpp"
#include "transport/dds/participants.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <netinet/in.h>
#include <random>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "tactus.h"

namespace
{

/// Peer without DDS: datagrams on the loopback's ports.
class RawRtps
{
public:
    using Datagram = std::vector<std::uint8_t>;
    using Guid = std::array<std::uint8_t, 16>;

    /// Sample of a server's motion, in the name of that writer, with the sequence number 2^40 and
    /// the largest serial number: object 0 is at the origin.
    [[nodiscard]] static Datagram later_motion(const Guid& writer, std::uint64_t server_epoch);
    /// Heartbeat in the writer's name: all samples before 2^40 are gone.
    [[nodiscard]] static Datagram later_heartbeat(const Guid& writer, std::uint64_t server_epoch);

    /// Listens on one of the domain's discovery ports.
    explicit RawRtps(std::uint32_t domain);
    ~RawRtps();
    RawRtps(const RawRtps&) = delete;
    RawRtps& operator=(const RawRtps&) = delete;

    /// Stores some of the announcements since the last call.
    void listen();
    /// Sets another participant's identity of 12 bytes for half of the datagrams from now on.
    void speak_as(const std::uint8_t* prefix) { prefix_.assign(prefix, prefix + 12); }
    [[nodiscard]] bool has_heard() const { return !heard_.empty(); }

    /// Random stored announcement.
    [[nodiscard]] Datagram any_heard();
    /// Stored announcement with some bytes changed, cut or longer; sizes and magic unchanged.
    [[nodiscard]] Datagram any_garbled();
    /// Stored announcement under a new identity, with an unlimited lease. Requires has_heard().
    [[nodiscard]] Datagram another_participant();
    /// RTPS header with random content.
    [[nodiscard]] Datagram nonsense();

    void send(const Datagram& datagram, std::uint16_t port) const;

private:
    [[nodiscard]] std::size_t below(std::size_t end)
    {
        return static_cast<std::size_t>(random_() % end);
    }

    int socket_;
    std::vector<Datagram> heard_;
    std::vector<std::uint8_t> prefix_;
    std::mt19937_64 random_{20260730};
};

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

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// Limit of the wait; only an absent peer takes that long.
std::chrono::seconds patience()
{
    const char* text = std::getenv("ATTACKER_PATIENCE_S");
    return std::chrono::seconds(text != nullptr ? std::atoi(text) : 150);
}

std::int32_t checked(std::int32_t handle)
{
    if (handle < 0)
    {
        std::fprintf(stderr, "attacker: %s\n", dds_strretcode(-handle));
        std::exit(2);
    }
    return handle;
}

class Attacker
{
public:
    explicit Attacker(std::uint32_t of_domain) : Attacker(of_domain, {})
    {
        catalogue_ = reader("tactus/v5/catalogue", tactus_v5_CatalogueEntry_desc);
        wanted_ = reader("tactus/v5/wanted", tactus_v5_Wanted_desc);
    }
    /// Another participant of the same process, which knows what that one has seen.
    Attacker(std::uint32_t of_domain, const tactus_v5_CatalogueEntry& seen)
        : server(seen)
        , domain(of_domain)
        , participant_(checked(dds_create_participant(of_domain, nullptr, nullptr)))
    {
        dds_guid_t guid = {};
        dds_get_guid(participant_, &guid);
        std::memcpy(own_.data(), static_cast<const std::uint8_t*>(guid.v), own_.size());
    }
    ~Attacker() { dds_delete(participant_); }
    Attacker(const Attacker&) = delete;
    Attacker& operator=(const Attacker&) = delete;

    /// True once a server and its controller were seen.
    bool sees_both()
    {
        const auto end = Clock::now() + patience();
        while (Clock::now() < end && (server.server_epoch == 0 || victim.server_epoch == 0))
        {
            take(catalogue_, server);
            take(wanted_, victim);
            std::this_thread::sleep_for(5ms);
        }
        return server.server_epoch != 0 && victim.server_epoch != 0;
    }

    /// Writer with the QoS of the honest ones, so that all readers match and one of the others has.
    [[nodiscard]] std::int32_t writer(const char* topic, const dds_topic_descriptor_t& type,
                                      const std::string& partition, bool best_effort = false) const
    {
        dds_qos_t* qos = dds_create_qos();
        const char* name = partition.c_str();
        dds_qset_partition(qos, 1, &name);
        const auto publisher = checked(dds_create_publisher(participant_, qos, nullptr));
        dds_reset_qos(qos);
        dds_qset_reliability(qos,
                             best_effort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
                             DDS_MSECS(5));
        dds_qset_durability(qos,
                            best_effort ? DDS_DURABILITY_VOLATILE : DDS_DURABILITY_TRANSIENT_LOCAL);
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 16);
        const auto of = checked(dds_create_topic(participant_, &type, topic, nullptr, nullptr));
        const auto made = checked(dds_create_writer(publisher, of, qos, nullptr));
        dds_delete_qos(qos);
        const auto end = Clock::now() + patience();
        while (!is_heard(made))
        {
            if (Clock::now() > end)
            {
                std::fprintf(stderr, "attacker: nobody reads %s\n", topic);
                std::exit(2);
            }
            std::this_thread::sleep_for(5ms);
        }
        return made;
    }
    [[nodiscard]] std::string server_partition() const
    {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "server.%016llx",
                      static_cast<unsigned long long>(server.server_epoch));
        return text.data();
    }
    [[nodiscard]] std::string victim_name() const
    {
        return static_cast<const char*>(victim.controller_name);
    }
    /// Partition of the server's pieces for the victim.
    [[nodiscard]] std::string victim_partition() const
    {
        tactus::ContentHash id{};
        std::memcpy(id.data(), victim.controller, id.size());
        return victim_name() + "." + tactus::hash_text(id);
    }
    /// Epoch by which the others' filters take us for a server.
    [[nodiscard]] std::uint64_t own_epoch() const { return tactus::dds::server_epoch_of(own_); }
    [[nodiscard]] const std::array<std::uint8_t, 16>& own() const { return own_; }

    /// Reader of all partitions, or reliably of ours alone.
    [[nodiscard]] std::int32_t reader(const char* topic, const dds_topic_descriptor_t& type,
                                      const std::string& partition = "*") const
    {
        dds_qos_t* qos = dds_create_qos();
        const char* name = partition.c_str();
        dds_qset_partition(qos, 1, &name);
        const auto subscriber = checked(dds_create_subscriber(participant_, qos, nullptr));
        dds_reset_qos(qos);
        dds_qset_reliability(
            qos, partition == "*" ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE, 0);
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 16);
        const auto of = checked(dds_create_topic(participant_, &type, topic, nullptr, nullptr));
        const auto made = checked(dds_create_reader(subscriber, of, qos, nullptr));
        dds_delete_qos(qos);
        return made;
    }

    /// Partition of the server's pieces for us under that name.
    [[nodiscard]] std::string own_partition(const std::string& name) const
    {
        return name + "." + tactus::hash_text(own_);
    }
    /// GUIDs of the server's writers of a topic, which discovery publishes.
    [[nodiscard]] std::vector<RawRtps::Guid> writers_of_server(const std::string& topic) const
    {
        const auto known = checked(
            dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
        std::vector<RawRtps::Guid> found;
        void* sample = nullptr;
        dds_sample_info_t info = {};
        for (; dds_take(known, &sample, &info, 1, 1) == 1; sample = nullptr)
        {
            const auto& writer = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
            tactus::dds::ParticipantId who{};
            std::memcpy(who.data(), writer.participant_key.v, who.size());
            if (info.valid_data && topic == writer.topic_name &&
                tactus::dds::server_epoch_of(who) == server.server_epoch)
            {
                std::memcpy(found.emplace_back().data(), writer.key.v, sizeof(writer.key.v));
            }
            dds_return_loan(known, &sample, 1);
        }
        dds_delete(known);
        return found;
    }
    [[nodiscard]] std::int32_t participant() const { return participant_; }

    std::vector<std::uint16_t> ports;  ///< UDP ports of the others.
    std::shared_ptr<RawRtps> raw;      ///< Sender for attacks without DDS.
    tactus_v5_CatalogueEntry server{}; ///< Observed state.
    tactus_v5_Wanted victim{};
    std::uint32_t domain;

private:
    /// Takes a sample without the data behind its pointers.
    template <typename Sample>
    static void take(std::int32_t reader, Sample& out)
    {
        void* sample = nullptr;
        dds_sample_info_t info = {};
        while (dds_take(reader, &sample, &info, 1, 1) == 1)
        {
            out = info.valid_data ? *static_cast<const Sample*>(sample) : out;
            dds_return_loan(reader, &sample, 1);
            sample = nullptr;
        }
    }

    /// True if a foreign reader has matched.
    [[nodiscard]] bool is_heard(std::int32_t writer) const
    {
        std::array<dds_instance_handle_t, 16> readers{};
        const auto count = dds_get_matched_subscriptions(writer, readers.data(), readers.size());
        const auto is_foreign = [&](dds_instance_handle_t reader)
        {
            auto* end = dds_get_matched_subscription_data(writer, reader);
            if (end == nullptr)
            {
                return false;
            }
            const bool is_own = std::memcmp(end->participant_key.v, own_.data(), own_.size()) == 0;
            dds_builtintopic_free_endpoint(end);
            return !is_own;
        };
        return std::any_of(readers.begin(), readers.begin() + std::clamp(count, 0, 16), is_foreign);
    }

    std::int32_t participant_;
    std::int32_t catalogue_{0};
    std::int32_t wanted_{0};
    std::array<std::uint8_t, 16> own_{};
};

/// Factory of the repeated action.
using Attack = std::function<std::function<void(std::uint64_t turn)>(Attacker&)>;

tactus_v5_Placement placement(double x_m)
{
    tactus_v5_Placement place = {};
    place.rotation[3] = 1.0;
    place.translation_m[0] = x_m;
    place.scale = 1.0;
    return place;
}

/// Moves the first object: to its own place, or `x_m` farther along x every other time.
Attack move_object(std::uint64_t serial, double x_m)
{
    return [=](Attacker& self)
    {
        const auto motion =
            self.writer("tactus/v5/motion", tactus_v5_Motion_desc, self.server_partition(), true);
        const auto records =
            self.writer("tactus/v5/objects", tactus_v5_ObjectRecord_desc, self.server_partition());
        return [=, &self](std::uint64_t turn)
        {
            tactus_v5_MovedObject moved{0, 1, placement(turn % 2 == 0 ? x_m : 0.0)};
            tactus_v5_Motion sample = {};
            sample.server_epoch = self.server.server_epoch;
            sample.serial = serial == 0 ? 1'000'000 + turn : serial;
            sample.server_time_ns = static_cast<std::int64_t>(turn) * 4'000'000;
            sample.objects = 1;
            sample.moved = {1, 1, &moved, false};
            dds_write(motion, &sample);
            tactus_v5_ObjectRecord record = {};
            record.server_epoch = self.server.server_epoch;
            record.generation = 1;
            record.serial = sample.serial;
            std::strcpy(static_cast<char*>(record.name), "false");
            std::memcpy(record.model_hash, self.server.model_hash, sizeof(record.model_hash));
            record.pose = moved.pose;
            dds_write(records, &record);
        };
    };
}

Attack dispose_catalogue()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v5/catalogue", tactus_v5_CatalogueEntry_desc, "");
        return [=, &self](std::uint64_t) { dds_dispose(writer, &self.server); };
    };
}

/// Sends the server's entry with another hash.
Attack forge_catalogue()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v5/catalogue", tactus_v5_CatalogueEntry_desc, "");
        return [=, &self](std::uint64_t)
        {
            tactus_v5_CatalogueEntry entry = self.server;
            entry.model_hash[0] ^= 1U;
            dds_write(writer, &entry);
        };
    };
}

/// Number; every other one is not a valid model or object.
std::uint32_t number_in(std::uint64_t turn)
{
    constexpr std::uint64_t kBeyond = 1'000'000;
    return static_cast<std::uint32_t>(turn % 2 == 0 ? turn / 2 : kBeyond + turn);
}

/// Sends models of many names, under the server's epoch and our own.
Attack spam_catalogue()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v5/catalogue", tactus_v5_CatalogueEntry_desc, "");
        return [=, &self](std::uint64_t turn)
        {
            tactus_v5_CatalogueEntry entry = self.server;
            std::snprintf(static_cast<char*>(entry.name), sizeof(entry.name), "bogus-%llu",
                          static_cast<unsigned long long>(turn));
            entry.model = number_in(turn);
            dds_write(writer, &entry);
            entry.server_epoch = self.own_epoch();
            dds_write(writer, &entry);
        };
    };
}

/// Sends controllers of many ids, with the server's epoch or another one.
Attack spam_wanted(bool right_epoch)
{
    return [=](Attacker& self)
    {
        const auto writer = self.writer("tactus/v5/wanted", tactus_v5_Wanted_desc, "stranger");
        return [=, &self](std::uint64_t turn)
        {
            tactus_v5_Wanted wanted = {};
            std::memcpy(wanted.controller, self.own().data(), self.own().size());
            std::memcpy(wanted.controller, &turn, sizeof(turn));
            wanted.server_epoch = self.server.server_epoch + (right_epoch ? 0 : 1 + turn);
            wanted.granted = 128;
            std::strcpy(static_cast<char*>(wanted.controller_name), "stranger");
            dds_write(writer, &wanted);
        };
    };
}

/// Sends requests in the victim's name, with unlimited credit.
Attack forge_wanted()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v5/wanted", tactus_v5_Wanted_desc, self.victim_name());
        return [=, &self](std::uint64_t turn)
        {
            std::array<tactus_v5_PieceName, 200> names{};
            for (std::uint32_t i = 0; i < names.size(); ++i)
            {
                names.at(i) = {0, 2, i};
            }
            tactus_v5_Wanted wanted = self.victim;
            wanted.generation = static_cast<std::uint32_t>(1'000'000 + turn);
            wanted.seen = wanted.received = 0;
            wanted.granted = UINT64_MAX;
            wanted.pieces = {200, 200, names.data(), false};
            dds_write(writer, &wanted);
        };
    };
}

Attack dispose_wanted()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v5/wanted", tactus_v5_Wanted_desc, self.victim_name());
        return [=, &self](std::uint64_t)
        {
            tactus_v5_Wanted wanted = self.victim;
            wanted.pieces = {};
            dds_dispose(writer, &wanted);
        };
    };
}

/// Reports the first object as removed.
Attack dispose_object()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v5/objects", tactus_v5_ObjectRecord_desc, self.server_partition());
        return [=, &self](std::uint64_t)
        {
            tactus_v5_ObjectRecord record = {};
            record.server_epoch = self.server.server_epoch;
            dds_dispose(writer, &record);
        };
    };
}

/// Sends objects of many numbers, under the server's epoch and our own.
Attack spam_objects()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v5/objects", tactus_v5_ObjectRecord_desc, self.server_partition());
        return [=, &self](std::uint64_t turn)
        {
            tactus_v5_ObjectRecord record = {};
            record.server_epoch = self.server.server_epoch;
            record.object = number_in(turn);
            record.generation = 1'000;
            record.serial = 1;
            std::strcpy(static_cast<char*>(record.name), "false");
            std::memcpy(record.model_hash, self.server.model_hash, sizeof(record.model_hash));
            record.pose = placement(0.0);
            dds_write(writer, &record);
            record.server_epoch = self.own_epoch();
            dds_write(writer, &record);
        };
    };
}

/// Sends pieces to the victim, in the server's name and in our own, whose counts use up all credit.
Attack forge_pieces()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v5/chunks", tactus_v5_Pieces_desc, self.victim_partition());
        return [=, &self](std::uint64_t turn)
        {
            std::array<std::uint8_t, 4'000> bytes{};
            std::memcpy(bytes.data(), self.server.model_hash, sizeof(self.server.model_hash));
            bytes[20] = 2; // Kind: chunk.
            bytes[24] = static_cast<std::uint8_t>(turn);
            bytes[28] = 100;
            tactus_v5_Pieces pieces = {};
            pieces.sent = UINT64_MAX;
            pieces.payload = {bytes.size(), bytes.size(), bytes.data(), false};
            for (const std::uint64_t epoch : {self.server.server_epoch, self.own_epoch()})
            {
                pieces.server_epoch = epoch;
                dds_write(writer, &pieces);
            }
        };
    };
}

/// Repeats the server's pieces to the victim.
Attack replay_pieces()
{
    return [](Attacker& self)
    {
        const auto from = self.reader("tactus/v5/chunks", tactus_v5_Pieces_desc);
        const auto writer =
            self.writer("tactus/v5/chunks", tactus_v5_Pieces_desc, self.victim_partition());
        return [=](std::uint64_t)
        {
            std::array<void*, 4> samples{};
            std::array<dds_sample_info_t, 4> infos{};
            const auto count = dds_read(from, samples.data(), infos.data(), 4, 4);
            for (std::int32_t i = 0; i < count; ++i)
            {
                if (infos.at(static_cast<std::size_t>(i)).valid_data)
                {
                    dds_write(writer, samples.at(static_cast<std::size_t>(i)));
                }
            }
            if (count > 0)
            {
                dds_return_loan(from, samples.data(), count);
            }
        };
    };
}

/// Sends telemetry in the victim's name, and in invalid names.
Attack forge_telemetry()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v5/telemetry", tactus_v5_Telemetry_desc, self.victim_name(), true);
        return [=, &self](std::uint64_t turn)
        {
            tactus_v5_Telemetry news = {};
            std::memcpy(news.controller, self.victim.controller, sizeof(news.controller));
            std::strcpy(static_cast<char*>(news.controller_name), "victim");
            news.serial = UINT64_MAX;
            news.frame = 77'777'777;
            dds_write(writer, &news);
            std::memcpy(news.controller, self.own().data(), self.own().size());
            std::strcpy(static_cast<char*>(news.controller_name), "\x1b[31mred\x07");
            news.serial = turn;
            dds_write(writer, &news);
        };
    };
}

/// Adds and removes a controller, sometimes with an invalid name.
Attack visit()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v5/wanted", tactus_v5_Wanted_desc, "stranger");
        return [=, &self](std::uint64_t turn)
        {
            tactus_v5_Wanted wanted = {};
            std::memcpy(wanted.controller, self.own().data(), self.own().size());
            wanted.server_epoch = self.server.server_epoch;
            wanted.granted = 128;
            std::strcpy(static_cast<char*>(wanted.controller_name),
                        turn % 8 == 0 ? "\x1b[31mred\x07" : "stranger");
            dds_write(writer, &wanted);
            std::this_thread::sleep_for(
                1ms); // The pause keeps the two from merging into one event.
            dds_dispose(writer, &wanted);
        };
    };
}

/// Creates 50 controllers in one process, each with 256 requests 50 times a second, readers of its
/// own, unlimited credit, and a request for the objects.
Attack crowd_of_controllers()
{
    struct Member
    {
        std::unique_ptr<Attacker> self;
        std::int32_t writer;
        std::int32_t reader;
        std::uint64_t seen;
    };
    return [](Attacker& first)
    {
        const auto members = std::make_shared<std::vector<Member>>();
        for (int i = 0; i < 50; ++i)
        {
            auto self = std::make_unique<Attacker>(first.domain, first.server);
            const auto reader = self->reader("tactus/v5/chunks", tactus_v5_Pieces_desc,
                                             self->own_partition("crowd"));
            const auto writer = self->writer("tactus/v5/wanted", tactus_v5_Wanted_desc, "crowd");
            members->push_back({std::move(self), writer, reader, 0});
        }
        return [=](std::uint64_t turn)
        {
            std::array<tactus_v5_PieceName, 256> names{};
            for (std::uint32_t i = 0; i < names.size(); ++i)
            {
                names.at(i) = {0, 2, i};
            }
            tactus_v5_Wanted wanted = {};
            wanted.server_epoch = members->front().self->server.server_epoch;
            wanted.generation = static_cast<std::uint32_t>(turn);
            wanted.objects = 1;
            wanted.granted = std::uint64_t{1} << 63U;
            wanted.pieces = {256, 256, names.data(), false};
            std::strcpy(static_cast<char*>(wanted.controller_name), "crowd");
            for (Member& member : *members)
            {
                std::memcpy(wanted.controller, member.self->own().data(),
                            sizeof(wanted.controller));
                wanted.seen = member.seen;
                dds_write(member.writer, &wanted);
                void* sample = nullptr;
                dds_sample_info_t info = {};
                for (; dds_take(member.reader, &sample, &info, 1, 1) == 1; sample = nullptr)
                {
                    member.seen = static_cast<const tactus_v5_Pieces*>(sample)->sent;
                    dds_return_loan(member.reader, &sample, 1);
                }
            }
        };
    };
}

/// Creates `count` idle participants in one process.
Attack crowd_of_participants(int count)
{
    return [=](Attacker& self)
    {
        for (int i = 0; i < count; ++i)
        {
            checked(dds_create_participant(self.domain, nullptr, nullptr));
        }
        return [](std::uint64_t) {};
    };
}

/// Creates `count` readers of one participant.
Attack crowd_of_endpoints(int count)
{
    return [=](Attacker& self)
    {
        const auto topic = checked(dds_create_topic(self.participant(), &tactus_v5_Pieces_desc,
                                                    "tactus/v5/chunks", nullptr, nullptr));
        for (int i = 0; i < count; ++i)
        {
            checked(dds_create_reader(self.participant(), topic, nullptr, nullptr));
        }
        return [](std::uint64_t) {};
    };
}

/// Sends a packet in the name of each of the server's writers of a topic that announces a much
/// later sample.
Attack forge_sequence(const char* topic,
                      RawRtps::Datagram (*make)(const RawRtps::Guid&, std::uint64_t server_epoch))
{
    return [=](Attacker& self)
    {
        return [=, &self](std::uint64_t)
        {
            const auto writers = self.writers_of_server(topic);
            if (writers.empty() || self.ports.empty())
            {
                std::fprintf(stderr, "attacker: found no writer of %s, or was told no ports\n",
                             topic);
                std::exit(2);
            }
            for (const RawRtps::Guid& writer : writers)
            {
                for (const std::uint16_t port : self.ports)
                {
                    self.raw->send(make(writer, self.server.server_epoch), port);
                }
            }
        };
    };
}

/// Sends datagrams by `make` to all ports of the others.
Attack send_raw(RawRtps::Datagram (*make)(RawRtps&))
{
    return [=](Attacker& self)
    {
        const auto raw = self.raw;
        for (const auto end = Clock::now() + patience(); !raw->has_heard() && Clock::now() < end;
             std::this_thread::sleep_for(5ms))
        {
            raw->listen();
        }
        raw->speak_as(self.victim.controller);
        if (!raw->has_heard() || self.ports.empty())
        {
            std::fprintf(stderr, "attacker: heard nobody, or was told no ports\n");
            std::exit(2);
        }
        return [=, &self](std::uint64_t)
        {
            raw->listen();
            for (const std::uint16_t port : self.ports)
            {
                raw->send(make(*raw), port);
            }
        };
    };
}

struct Habit
{
    Attack attack;
    std::chrono::microseconds every;
    std::uint64_t least; ///< Least number of repetitions.
};

const std::map<std::string, Habit>& habits()
{
    static const std::map<std::string, Habit> all{
        {"pose_lock", {move_object(UINT64_MAX, 0.0), 50ms, 20}},
        {"pose_swing", {move_object(0, 0.005), 4ms, 200}},
        {"catalogue_disposed", {dispose_catalogue(), 50ms, 20}},
        {"catalogue_forged", {forge_catalogue(), 50ms, 20}},
        {"catalogue_flooded", {spam_catalogue(), 200us, 3'000}},
        {"wanted_flooded", {spam_wanted(true), 200us, 3'000}},
        {"wanted_flooded_epochs", {spam_wanted(false), 200us, 3'000}},
        {"wanted_forged", {forge_wanted(), 5ms, 150}},
        {"wanted_disposed", {dispose_wanted(), 50ms, 20}},
        {"object_disposed", {dispose_object(), 2ms, 300}},
        {"objects_flooded", {spam_objects(), 200us, 3'000}},
        {"pieces_forged", {forge_pieces(), 5ms, 150}},
        {"pieces_replayed", {replay_pieces(), 5ms, 150}},
        {"telemetry_forged", {forge_telemetry(), 5ms, 150}},
        {"log_flooded", {visit(), 1ms, 500}},
        {"rtps_garbled", {send_raw([](RawRtps& raw) { return raw.any_garbled(); }), 2ms, 400}},
        {"rtps_replayed", {send_raw([](RawRtps& raw) { return raw.any_heard(); }), 1ms, 600}},
        {"rtps_participants",
         {send_raw([](RawRtps& raw) { return raw.another_participant(); }), 500us, 5'000}},
        {"rtps_motion_deaf", {forge_sequence("tactus/v5/motion", RawRtps::later_motion), 5s, 2}},
        {"rtps_pieces_deaf", {forge_sequence("tactus/v5/chunks", RawRtps::later_heartbeat), 5s, 2}},
        {"controllers_flooded", {crowd_of_controllers(), 20ms, 250}},
        {"participants_flooded", {crowd_of_participants(300), 10ms, 500}},
        {"endpoints_flooded", {crowd_of_endpoints(3'000), 10ms, 500}},
        {"rtps_nonsense", {send_raw([](RawRtps& raw) { return raw.nonsense(); }), 100us, 5'000}},
    };
    return all;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string attack = argc >= 4 ? argv[3] : "";
    const std::size_t at = std::min(attack.find('@'), attack.size());
    const auto habit = habits().find(attack.substr(0, at));
    if (habit == habits().end())
    {
        std::fprintf(stderr, "attacker DOMAIN SECONDS ATTACK[@MICROSECONDS] [PORT...]; attacks:");
        for (const auto& [name, unused] : habits())
        {
            std::fprintf(stderr, " %s", name.c_str());
        }
        std::fprintf(stderr, "\n");
        return 3;
    }
    const auto domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
    // The raw socket is opened first, since our participant announces itself to all ports at its
    // start.
    const auto raw = habit->first.starts_with("rtps_") ? std::make_shared<RawRtps>(domain)
                                                       : std::shared_ptr<RawRtps>();
    Attacker attacker(domain);
    attacker.raw = raw;
    if (!attacker.sees_both())
    {
        std::fprintf(stderr, "attacker: saw no server and controller\n");
        return 2;
    }
    for (int i = 4; i < argc; ++i)
    {
        attacker.ports.push_back(static_cast<std::uint16_t>(std::atoi(argv[i])));
    }
    const auto act = habit->second.attack(attacker);
    const std::chrono::microseconds pause =
        at < attack.size() ? std::chrono::microseconds(std::atoi(attack.c_str() + at + 1))
                           : habit->second.every;
    std::printf("begun\n");
    std::fflush(stdout);
    const auto start = Clock::now();
    const auto end = start + std::chrono::duration<double>(std::atof(argv[2]));
    std::uint64_t turn = 0;
    for (; turn < habit->second.least || Clock::now() < end; ++turn)
    {
        act(turn);
        if (pause.count() > 0)
        {
            std::this_thread::sleep_for(pause);
        }
    }
    std::printf("done %llu times in %.2f s\n", static_cast<unsigned long long>(turn),
                std::chrono::duration<double>(Clock::now() - start).count());
    return 0;
}
