// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/remote/remote_device.hpp"
#include "platform/devices/udp/session.hpp"
#include "platform/devices/udp/socket.hpp"
#include "platform/machine/rt_thread.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace tactus
{

struct UdpDeviceOptions
{
    static constexpr int kPortDefault = 48'500;
    static constexpr Duration kPollMin = microseconds(20);
    static constexpr Duration kPollMax = milliseconds(10);
    static constexpr Duration kWaitMax = milliseconds(3'600'000);
    static constexpr Duration kDelayMax = milliseconds(100);
    static constexpr Duration kAskEvery = milliseconds(50);

    /// Numeric IPv4 address. Without an authenticator any sender that reaches it can move the tool:
    /// keep it local to this machine.
    std::string address{"127.0.0.1"};
    int port{kPortDefault}; ///< Port, as in udp::Socket::open().
    /// Time to wait for a device's description, up to kWaitMax.
    Duration wait{milliseconds(10'000)};
    /// Called every kAskEvery during the wait, on the calling thread: false ends it. Empty: never.
    std::function<bool()> goes_on;
    /// Interval at which the I/O thread checks for a force to send, in [kPollMin, kPollMax]; it
    /// adds to the delay of a force.
    Duration poll{microseconds(100)};
    /// Round-trip delay, up to kDelayMax; added to the device's own delay. The default is that of
    /// loopback with the default poll: docs/udp-device.md.
    Duration transport_delay{microseconds(400)};
    RemoteTimes times;
    /// Time for which a silent device keeps its place, up to kWaitMax.
    Duration place{milliseconds(3'000)};
    /// Time for which a device must have sent samples before its limits are used, up to kWaitMax,
    /// while no other device describes itself. 0: the first description is accepted.
    Duration proof{milliseconds(300)};
    /// Key shared with the driver; borrowed, outlives the device; null: every sender is accepted.
    const udp::Authenticator* authenticator{nullptr};
    DeviceFrame frame;
    RtThreadOptions thread{io_thread_options()}; ///< Options of the I/O thread.
    const Clock* clock{nullptr}; ///< Clock, borrowed; it outlives the device. Not null.
};

/// Counts of datagrams since create().
struct UdpTraffic
{
    std::uint64_t described{0}; ///< Accepted descriptions, including the first one.
    std::uint64_t samples{0};   ///< Accepted samples.
    std::uint64_t sessions{0};  ///< Devices attached one after the other.
    std::uint64_t lost{0};      ///< Number of times that a device was silent for too long.
    std::uint64_t forces{0};    ///< Forces sent by the I/O thread.
    std::uint64_t unsent{0};    ///< Forces that the system refused to send.
    /// Datagrams refused, by udp::DatagramFault.
    std::array<std::uint64_t, udp::kDatagramFaults> refused{};
    const char* wrong_value{nullptr}; ///< Value at fault in the last datagram with wrong content.
    /// Descriptions of another device since the last accepted datagram: the settled one has gone
    /// and lost its place.
    std::uint64_t others{0};
};

/// A device driven by another program, over the datagrams of docs/udp-device.md. The socket belongs
/// to the I/O thread; other threads use it only in brake().
class UdpDevice final : public RemoteDevice
{
public:
    /// Waits on the calling thread until a device has described and proved itself. Refuses options
    /// out of range, all that udp::Socket::open() and RtThread::start() refuse, a wait that ends
    /// without a device, and several devices. A null clock is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<UdpDevice>, Refusal>
    create(const UdpDeviceOptions& options);
    /// Like the other create(), with an open socket; the options' address and port are ignored.
    [[nodiscard]] static Result<std::unique_ptr<UdpDevice>, Refusal>
    create(udp::Socket socket, const UdpDeviceOptions& options);

    UdpDevice(const UdpDevice&) = delete;
    UdpDevice& operator=(const UdpDevice&) = delete;
    /// Sends the device the state idle.
    ~UdpDevice() override;

    /// Sends zero force and the brake at once, by a non-blocking system call on the calling thread;
    /// the I/O thread repeats it, since datagrams get lost.
    void brake() noexcept override;

    /// Recent counts. Any thread except the haptic one, since it may wait.
    [[nodiscard]] UdpTraffic traffic() const noexcept;
    /// Rights granted to the I/O thread.
    [[nodiscard]] const RtThreadReport& thread_report() const noexcept { return thread_->report(); }

private:
    /// Interval at which an unchanged force is sent again: datagrams get lost, and the device drops
    /// the force after 20 ms without one.
    static constexpr Duration kRepeat = milliseconds(5);
    /// Poll interval without a device.
    static constexpr Duration kIdlePoll = milliseconds(5);
    /// Datagrams received in a row at most, so that a flood doesn't delay the forces.
    static constexpr int kDatagramsMax = 64;

    UdpDevice(udp::Socket socket, udp::Session session, std::uint64_t sequence,
              const DeviceInfo& info, const UdpDeviceOptions& options);

    void run() noexcept;
    [[nodiscard]] bool receive_all() noexcept;
    [[nodiscard]] bool receive_one(std::span<const std::byte> bytes, const udp::Endpoint& from);
    void send_due(bool is_asked) noexcept;
    bool send(const udp::ForceDatagram& datagram, const udp::Endpoint& to) const noexcept;
    void send(const udp::Peer& peer, std::uint64_t sequence, const DeviceCommand& command,
              std::uint64_t answers) noexcept;

    udp::Socket socket_;
    const Duration poll_;
    const udp::Authenticator* const authenticator_;
    /// Sequence of the last datagram sent; see send_due().
    std::atomic<std::uint64_t> sequence_{0};
    Mailbox<udp::Peer> peer_;     ///< Peer for brake(); written by the I/O thread.
    Mailbox<UdpTraffic> traffic_; ///< Counts written by the I/O thread.
    std::atomic<bool> is_stopped_{false};

    // Used by the I/O thread.
    udp::Session session_;
    UdpTraffic counts_;
    DeviceCommand sent_;
    MonotonicTime sent_at_;

    std::optional<RtThread> thread_; ///< Thread; it ends before all that it uses.
};

} // namespace tactus
