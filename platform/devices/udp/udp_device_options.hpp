// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/device_frame.hpp"
#include "platform/devices/remote/remote_values.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/time.hpp"

#include <functional>
#include <string>

namespace tactus::udp
{

class Authenticator;

} // namespace tactus::udp

namespace tactus
{

class Clock;

/// Address, times and key for a device that sends datagrams.
struct UdpDeviceOptions
{
    static constexpr int kPortDefault = 48'500;
    static constexpr Duration kPollMin = microseconds(20);
    static constexpr Duration kPollMax = milliseconds(10);
    static constexpr Duration kWaitMax = milliseconds(3'600'000);
    static constexpr Duration kDelayMax = milliseconds(100);
    static constexpr Duration kAskEvery = milliseconds(50);

    /// Numeric IPv4 address to listen on. Without an authenticator any sender that reaches it can
    /// move the tool, so use one that only this machine reaches.
    std::string address{"127.0.0.1"};
    int port{kPortDefault}; ///< Port, as in udp::Socket::open().
    /// Longest time that create() waits for a device, up to kWaitMax.
    Duration wait{milliseconds(10'000)};
    /// Called every kAskEvery while create() waits, on its thread; false ends the wait. May be
    /// empty.
    std::function<bool()> goes_on;
    /// Interval at which the I/O thread checks for a force to send, in [kPollMin, kPollMax]; it
    /// adds to the delay of a force.
    Duration poll{microseconds(100)};
    /// Round-trip delay, up to kDelayMax; added to the device's own delay. The default is that of
    /// loopback with the default poll: docs/udp-device.md.
    Duration transport_delay{microseconds(400)};
    RemoteTimes times;
    /// Time for which no other device may replace a silent one, up to kWaitMax.
    Duration place{milliseconds(3'000)};
    /// Time for which a device must be attached without a rival before create() accepts it, up to
    /// kWaitMax; see udp::Session::is_proven(). 0: create() accepts the first description.
    Duration proof{milliseconds(300)};
    /// Holds the key shared with the driver; borrowed, must outlive the device. Null: every sender
    /// is accepted.
    const udp::Authenticator* authenticator{nullptr};
    DeviceFrame frame;
    RtThreadOptions thread{io_thread_options()}; ///< Options of the I/O thread.
    const Clock* clock{nullptr};                 ///< Borrowed; must outlive the device. Not null.
};

} // namespace tactus
