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

/// Where a datagram comes from or goes to: IPv4 address and port.
struct Endpoint
{
    std::uint32_t address{0}; ///< 127.0.0.1 is 0x7F000001.
    std::uint16_t port{0};

    constexpr bool operator==(const Endpoint&) const noexcept = default;
};

/// Whom the controller talks to.
struct Peer
{
    Endpoint endpoint;
    std::uint64_t instance{0};
    std::uint64_t session{0};
    bool is_attached{false};
    std::uint16_t version{kVersion}; ///< Of its description, and so of all that it is told.
};

struct Described
{
};
struct Sampled
{
    DeviceReading reading;
    bool is_new{false}; ///< The device wasn't there before: RemoteDevice::publish().
};

/// The controller's side of the protocol: what is taken in, from whom, in which order. It knows
/// nothing of sockets and threads. One thread.
///
/// A device that describes itself when none is attached is, from then on, the only one that is
/// heard, until it is silent for too long. It is given a session number that nobody could have
/// known before, and its samples have to carry it: what was recorded in another session, or sent to
/// another controller, is refused. A device that comes back within its session goes on with it, and
/// one that has sent samples keeps its place for a while: nobody takes it from a driver that only
/// stumbled. With a seal nobody is heard who hasn't the key.
///
/// Until settle() no device has a place to keep: one that falls silent is forgotten with all that
/// it said of itself, and the next one may be quite another.
class Session
{
public:
    /// How far apart the device's time and ours may drift until they are set against each other
    /// anew.
    static constexpr Duration kClockDrift = milliseconds(100);
    /// A device describes itself every 100 ms: who did so this long ago is still there.
    static constexpr Duration kRivalry = milliseconds(250);
    /// Samples that a device has to send before it is settled on.
    static constexpr int kProof = 20;

    /// Who described itself while another one was attached.
    struct Rival
    {
        Endpoint endpoint;
        MonotonicTime heard;
    };

    /// `secret` is the first session's number; later ones count up from there. `place`: for so long
    /// after its last sample a device keeps its place. `seal` is lent; null: all are believed.
    Session(std::uint64_t secret, Duration silence, Duration place = {},
            const Seal* seal = nullptr) noexcept
        : next_(secret), silence_(silence), place_(place), seal_(seal)
    {
    }

    /// Takes in one datagram that came at `now`; a refusal changes nothing. Allocates for the
    /// first device's name at most.
    [[nodiscard]] std::variant<Described, Sampled, DatagramFault>
    receive(std::span<const std::byte> bytes, const Endpoint& from, MonotonicTime now);

    /// True once: when the device has been silent for too long.
    [[nodiscard]] bool lapse(MonotonicTime now) noexcept;

    /// Whether the device that is attached has been there for so long, has sent kProof samples, and
    /// no other one describes itself.
    [[nodiscard]] bool is_proven(Duration time, MonotonicTime now) const noexcept;
    /// From now on no device with other limits is let in.
    void settle() noexcept
    {
        is_settled_ = true;
        has_samples_ = false; // None is read yet.
        rival_.reset();
    }
    /// The last one before settle(); none without any.
    [[nodiscard]] const std::optional<Rival>& rival() const noexcept { return rival_; }

    /// The last one that was attached.
    [[nodiscard]] const Peer& peer() const noexcept { return peer_; }
    /// Of the last datagram that was accepted.
    [[nodiscard]] std::uint64_t answers() const noexcept { return last_sequence_; }
    /// What the device said of itself, in its own coordinates; none before that.
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
    const Seal* seal_;
    std::optional<DeviceInfo> info_;
    bool is_settled_{false}; ///< On a device with these limits.
    std::optional<Rival> rival_;
    MonotonicTime begun_; ///< The session.
    int samples_{0};      ///< In the session, up to kProof.
    Peer peer_;
    std::uint64_t last_sequence_{0};
    MonotonicTime heard_;           ///< The last sample, or the start of the session.
    bool has_samples_{false};       ///< In this attachment.
    std::int64_t last_time_ns_{-1}; ///< Of the last sample of this session; device's clock.
    std::int64_t clock_offset_ns_{0};
    MonotonicTime last_time_; ///< Of the last sample of all, on our clock.
};

} // namespace tactus::udp
