// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/remote/remote_device.hpp"
#include "platform/devices/udp/session.hpp"
#include "platform/devices/udp/socket.hpp"
#include "platform/devices/udp/udp_device_options.hpp"
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

/// Counts of datagrams since create().
struct UdpTraffic
{
    std::uint64_t described{0}; ///< Accepted descriptions, including the first one.
    std::uint64_t samples{0};   ///< Accepted samples.
    std::uint64_t sessions{0};  ///< Sessions begun, including the first one.
    std::uint64_t lost{0};      ///< Number of times that a device was silent for too long.
    std::uint64_t forces{0};    ///< Forces sent by the I/O thread.
    std::uint64_t unsent{0};    ///< Forces that the system refused to send.
    /// Refused datagrams, indexed by udp::DatagramFault.
    std::array<std::uint64_t, udp::kDatagramFaults> refused{};
    /// Name of the value at fault in the last datagram refused for its content; null: none.
    const char* wrong_value{nullptr};
    /// Descriptions that differ from the first one, since the last accepted datagram. Above 0: the
    /// first device has gone and lost its place.
    std::uint64_t others{0};
};

/// A device driven by another program, over the datagrams of docs/udp-device.md. The socket belongs
/// to the I/O thread; other threads use it only in brake().
class UdpDevice final : public RemoteDevice
{
public:
    /// Waits on the calling thread until a device has described and proved itself. Refuses options
    /// out of range, all that udp::Socket::open() and RtThread::start() refuse, a wait that ends
    /// without a device, and more than one device. A null clock is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<UdpDevice>, Refusal>
    create(const UdpDeviceOptions& options);
    /// Like create(options), with an open socket; the options' address and port are ignored.
    [[nodiscard]] static Result<std::unique_ptr<UdpDevice>, Refusal>
    create(udp::Socket socket, const UdpDeviceOptions& options);

    UdpDevice(const UdpDevice&) = delete;
    UdpDevice& operator=(const UdpDevice&) = delete;
    /// Ends the I/O thread, which sends the state idle as its last datagram.
    ~UdpDevice() override;

    /// Sends zero force and the state brake at once, by a non-blocking system call on the calling
    /// thread. The I/O thread repeats them, since datagrams get lost.
    void brake() noexcept override;

    /// Counts at the I/O thread's last cycle. Any thread except the haptic one, since the call may
    /// wait.
    [[nodiscard]] UdpTraffic traffic() const noexcept;
    /// Rights granted to the I/O thread.
    [[nodiscard]] const RtThreadReport& thread_report() const noexcept { return thread_->report(); }

private:
    /// Interval at which an unchanged force is sent again: datagrams get lost, and the device drops
    /// the force after 20 ms without one.
    static constexpr Duration kRepeat = milliseconds(5);
    /// Poll interval while no device is attached.
    static constexpr Duration kIdlePoll = milliseconds(5);
    /// Most datagrams received in a cycle of the I/O thread, so that a flood doesn't delay the
    /// forces.
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

    /// Last member: the thread ends before all that it uses.
    std::optional<RtThread> thread_;
};

} // namespace tactus
