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

/// Device program that a controller talks to.
struct Peer
{
    Endpoint endpoint;
    std::uint64_t instance{0};
    std::uint64_t session{0};
    bool is_attached{false};
    std::uint16_t version{kVersion}; ///< Version of its description, used in all replies.
};

/// An accepted description.
struct Described
{
};
/// An accepted reading.
struct Sampled
{
    DeviceReading reading;
    bool is_new{false}; ///< True for the first sample of an attachment.
};

/// The controller's side of the protocol: accepts datagrams by content, sender and order.
/// Independent of sockets and threads. One thread.
///
/// A device that describes itself while none is attached becomes attached. Others are refused until
/// it has sent no sample for `silence`. Its samples must carry the session's unpredictable number.
/// So samples of another session, or for another controller, are refused. If samples resume after a
/// silence, the session continues. A silent device that has sent samples keeps its place for
/// `place`: no other one is attached meanwhile. With an authenticator, each datagram needs a valid
/// tag.
///
/// Before settle() no device keeps a place: the next one may replace a silent device and have
/// another description.
class Session
{
public:
    /// Difference between device time and controller time at which their offset is set again.
    static constexpr Duration kClockDrift = milliseconds(100);
    /// Time after its last description for which a rival counts as present. Devices describe
    /// themselves every 100 ms.
    static constexpr Duration kRivalry = milliseconds(250);
    /// Number of samples that is_proven() requires.
    static constexpr int kProof = 20;

    /// A device that described itself while another one was attached.
    struct Rival
    {
        Endpoint endpoint;
        MonotonicTime heard;
    };

    /// `secret`: number of the first session; later ones count up from it. `silence`: time without
    /// a sample after which a device is detached. `place`: time after its last sample for which a
    /// device keeps its place. `authenticator`: borrowed; null: no tag is checked.
    Session(std::uint64_t secret, Duration silence, Duration place = {},
            const Authenticator* authenticator = nullptr) noexcept
        : next_(secret), silence_(silence), place_(place), authenticator_(authenticator)
    {
    }

    /// Processes one datagram that arrived at `now`. A refused one changes at most rival().
    /// Allocates only for the name in a description.
    [[nodiscard]] std::variant<Described, Sampled, DatagramFault>
    receive(std::span<const std::byte> bytes, const Endpoint& from, MonotonicTime now);

    /// Detaches a device that has been silent for longer than `silence`; returns true if it did.
    [[nodiscard]] bool lapse(MonotonicTime now) noexcept;

    /// True if a device has been attached for `time`, has sent kProof samples, and no rival is
    /// present.
    [[nodiscard]] bool is_proven(Duration time, MonotonicTime now) const noexcept;
    /// Fixes the description of the device: others are refused from now on. Clears rival().
    void settle() noexcept
    {
        is_settled_ = true;
        has_samples_ = false; // The next sample counts as the first.
        rival_.reset();
    }
    /// Last rival; none if there was none, and none after settle().
    [[nodiscard]] const std::optional<Rival>& rival() const noexcept { return rival_; }

    /// Device that is attached, or was attached last; Peer::is_attached tells which.
    [[nodiscard]] const Peer& peer() const noexcept { return peer_; }
    /// Sequence of the last datagram accepted from the device.
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
    bool is_settled_{false}; ///< True after settle(): the description is fixed.
    std::optional<Rival> rival_;
    MonotonicTime begun_; ///< Start of the session.
    int samples_{0};      ///< Samples in the session, up to kProof.
    Peer peer_;
    std::uint64_t last_sequence_{0};
    MonotonicTime heard_;           ///< Time of the last sample, or the start of the session.
    bool has_samples_{false};       ///< True after a sample in this attachment.
    std::int64_t last_time_ns_{-1}; ///< Device time of the session's last sample; -1: none.
    std::int64_t clock_offset_ns_{0};
    MonotonicTime last_time_; ///< Controller time of the last sample of all sessions.
};

} // namespace tactus::udp
