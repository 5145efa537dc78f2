// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/remote/remote_device.hpp"
#include "platform/devices/udp/datagram.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

namespace tactus::udp
{

/// IPv4 address and port.
struct Endpoint
{
    std::uint32_t address{0}; ///< Address; 127.0.0.1 is 0x7F000001.
    std::uint16_t port{0};

    constexpr bool operator==(const Endpoint&) const noexcept = default;
};

/// The controller's peer.
struct Peer
{
    Endpoint endpoint;
    std::uint64_t instance{0};
    std::uint64_t session{0};
    bool is_attached{false};
    std::uint16_t version{kVersion}; ///< Version of its description, used for all replies.
};

struct Described
{
};
struct Sampled
{
    DeviceReading reading;
    bool is_new{false}; ///< True if the device was not connected before: RemoteDevice::publish().
};

/// The controller's side of the protocol: accepts datagrams by content, sender and order.
/// Independent of sockets and threads. One thread.
///
/// The first device that describes itself while none is attached is attached: others are refused
/// until it is silent for too long. It gets an unpredictable session number, which its samples must
/// carry: those recorded in another session, or meant for another controller, are refused. A device
/// that returns within its session continues it, and one that has sent samples keeps its place for
/// a while, so that a short interruption of its driver loses nothing. With an authenticator all
/// datagrams need the key.
///
/// Until settle() no device has a place to keep: one that falls silent is forgotten with its
/// description, and the next one may be different.
class Session
{
public:
    /// Drift between the device's time and ours at which they are aligned again.
    static constexpr Duration kClockDrift = milliseconds(100);
    /// Time since its last description within which another device counts as present. A device
    /// describes itself every 100 ms.
    static constexpr Duration kRivalry = milliseconds(250);
    /// Samples that a device must send before it is settled on.
    static constexpr int kProof = 20;

    /// A device that described itself while another one was attached.
    struct Rival
    {
        Endpoint endpoint;
        MonotonicTime heard;
    };

    /// `secret`: number of the first session; later ones count up from there. `place`: time after
    /// its last sample for which a device keeps its place. `authenticator` is
    /// borrowed; null: all datagrams are accepted.
    Session(std::uint64_t secret, Duration silence, Duration place = {},
            const Authenticator* authenticator = nullptr) noexcept
        : next_(secret), silence_(silence), place_(place), authenticator_(authenticator)
    {
    }

    /// Processes one datagram that arrived at `now`; a refusal changes nothing. Allocates for the
    /// first device's name at most.
    [[nodiscard]] std::variant<Described, Sampled, DatagramFault>
    receive(std::span<const std::byte> bytes, const Endpoint& from, MonotonicTime now);

    /// True once after the device has been silent for too long.
    [[nodiscard]] bool lapse(MonotonicTime now) noexcept;

    /// True if the attached device has been there for this long, has sent kProof samples, and no
    /// other one describes itself.
    [[nodiscard]] bool is_proven(Duration time, MonotonicTime now) const noexcept;
    /// Refuses devices with other limits from now on.
    void settle() noexcept
    {
        is_settled_ = true;
        has_samples_ = false; // No sample is read yet.
        rival_.reset();
    }
    /// Last rival before settle(); none if there was none.
    [[nodiscard]] const std::optional<Rival>& rival() const noexcept { return rival_; }

    /// Last peer that was attached.
    [[nodiscard]] const Peer& peer() const noexcept { return peer_; }
    /// Sequence of the last accepted datagram.
    [[nodiscard]] std::uint64_t answers() const noexcept { return last_sequence_; }
    /// Description of the device, in its own coordinates; none before it arrives.
    [[nodiscard]] const std::optional<DeviceInfo>& info() const noexcept { return info_; }

private:
    [[nodiscard]] std::variant<Described, Sampled, DatagramFault>
    describe(const DescribeDatagram& datagram, const Endpoint& from, MonotonicTime now);
    [[nodiscard]] std::variant<Described, Sampled, DatagramFault>
    sample(const SampleDatagram& datagram, const Endpoint& from, MonotonicTime now) noexcept;
    [[nodiscard]] bool is_taken(MonotonicTime now) const noexcept;
    void begin(const Peer& peer, MonotonicTime now) noexcept;
    [[nodiscard]] MonotonicTime on_our_clock(std::int64_t time_ns, MonotonicTime now) noexcept;

    std::uint64_t next_;
    Duration silence_;
    Duration place_;
    const Authenticator* authenticator_;
    std::optional<DeviceInfo> info_;
    bool is_settled_{false}; ///< True if settled on a device with these limits.
    std::optional<Rival> rival_;
    MonotonicTime begun_; ///< Start of the session.
    int samples_{0};      ///< Samples in the session, up to kProof.
    Peer peer_;
    std::uint64_t last_sequence_{0};
    MonotonicTime heard_;           ///< Time of the last sample, or the start of the session.
    bool has_samples_{false};       ///< True after a sample in this attachment.
    std::int64_t last_time_ns_{-1}; ///< Time of the last sample of this session; device's clock.
    std::int64_t clock_offset_ns_{0};
    MonotonicTime last_time_; ///< Time of the last sample of all sessions, on our clock.
};

} // namespace tactus::udp
