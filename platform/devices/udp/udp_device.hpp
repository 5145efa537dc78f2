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

    /// Numeric IPv4. Without a seal whoever reaches it can move the tool: leave it where only this
    /// machine is.
    std::string address{"127.0.0.1"};
    int port{kPortDefault}; ///< As udp::Socket::open().
    /// For a device to describe itself, up to kWaitMax.
    Duration wait{milliseconds(10'000)};
    /// Asked every kAskEvery meanwhile, on the calling thread: false ends the wait. Empty: never.
    std::function<bool()> goes_on;
    /// How often the I/O thread looks for a force to send, in [kPollMin, kPollMax]: it adds as much
    /// to the delay of a force.
    Duration poll{microseconds(100)};
    /// Both ways together, up to kDelayMax; added to the delay that the device tells. The default
    /// is what loopback takes with the default poll: docs/udp-device.md.
    Duration transport_delay{microseconds(400)};
    RemoteTimes times;
    /// A device that has fallen silent keeps its place for so long, up to kWaitMax.
    Duration place{milliseconds(3'000)};
    /// Whose limits a run takes must have sent samples for so long before, up to kWaitMax, with
    /// no other device describes itself. 0: the first one that describes itself is believed.
    Duration proof{milliseconds(300)};
    /// By the key that the driver has; lent, it outlives the device; null: whoever speaks is
    /// believed.
    const udp::Seal* seal{nullptr};
    DeviceFrame frame;
    RtThreadOptions thread{io_thread_options()}; ///< The I/O thread.
    const Clock* clock{nullptr};                 ///< Lent; it outlives the device. Not null.
};

/// What has come and gone. Counts from create() on.
struct UdpTraffic
{
    std::uint64_t described{0}; ///< Accepted, the first one included.
    std::uint64_t samples{0};   ///< Accepted.
    std::uint64_t sessions{0};  ///< Devices that were attached one after the other.
    std::uint64_t lost{0};      ///< Times that one was silent for too long.
    std::uint64_t forces{0};    ///< Sent by the I/O thread.
    std::uint64_t unsent{0};    ///< Those of them that the system refused.
    std::array<std::uint64_t, udp::kDatagramFaults> refused{}; ///< By udp::DatagramFault.
    const char* wrong_value{nullptr}; ///< That the last of them had whose content was wrong.
    /// Descriptions of another device since the last datagram that was accepted: its own has gone,
    /// and given its place back.
    std::uint64_t others{0};
};

/// A device that another program drives, over the datagrams of docs/udp-device.md. The socket
/// belongs to the I/O thread; only brake() uses it from others.
class UdpDevice final : public RemoteDevice
{
public:
    /// Waits until a device has described and proved itself, on the calling thread. Refuses options
    /// out of range, what udp::Socket::open() and RtThread::start() refuse, and that nobody came
    /// within the time or before the wait was ended, or more than one. A null clock is a bug
    /// (asserted).
    [[nodiscard]] static Result<std::unique_ptr<UdpDevice>, Refusal>
    create(const UdpDeviceOptions& options);
    /// The same with a socket that is open already; the options' address and port aren't read.
    [[nodiscard]] static Result<std::unique_ptr<UdpDevice>, Refusal>
    create(udp::Socket socket, const UdpDeviceOptions& options);

    UdpDevice(const UdpDevice&) = delete;
    UdpDevice& operator=(const UdpDevice&) = delete;
    /// Tells the device to be idle.
    ~UdpDevice() override;

    /// Sends zero force and the brake at once, by a system call on the calling thread that doesn't
    /// wait; the I/O thread repeats it, since datagrams get lost.
    void brake() noexcept override;

    /// Any thread but the haptic one, since it may wait; a moment old.
    [[nodiscard]] UdpTraffic traffic() const noexcept;
    /// What the I/O thread got of what its options ask for.
    [[nodiscard]] const RtThreadReport& thread_report() const noexcept { return thread_->report(); }

private:
    /// A force is said again after so long, whether or not it is another: datagrams get lost, and
    /// the device drops it when it hears nothing for 20 ms.
    static constexpr Duration kRepeat = milliseconds(5);
    /// While nobody is there.
    static constexpr Duration kIdlePoll = milliseconds(5);
    /// Taken in at one go, so that a flood doesn't keep the forces back.
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
    const udp::Seal* const seal_;
    std::atomic<std::uint64_t> sequence_{0}; ///< Of the last datagram sent; see send_due().
    Mailbox<udp::Peer> peer_;                ///< For brake(); written by the I/O thread.
    Mailbox<UdpTraffic> traffic_;            ///< Written by the I/O thread.
    std::atomic<bool> is_stopped_{false};

    // The I/O thread's.
    udp::Session session_;
    UdpTraffic counts_;
    DeviceCommand sent_;
    MonotonicTime sent_at_;

    std::optional<RtThread> thread_; ///< Ends before anything that it uses.
};

} // namespace tactus
