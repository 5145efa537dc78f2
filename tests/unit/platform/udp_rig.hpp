// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/posix/posix_clock.hpp"
#include "platform/udp/udp_device.hpp"
#include "tests/unit/platform/device_rig.hpp"
#include "tests/unit/platform/udp_peer.hpp"

namespace tactus::test
{

/// A simulated device that obeys what a protocol says.
class ObedientDevice
{
public:
    [[nodiscard]] const DeviceInfo& info() const noexcept { return device_->info(); }

    [[nodiscard]] DeviceSample next(DeviceState state, const std::array<double, 3>& force_n)
    {
        if (state == DeviceState::brake)
        {
            device_->brake();
        }
        else if (state == DeviceState::idle || device_->status().state == DeviceState::brake)
        {
            device_->release_brake();
        }
        if (state == DeviceState::force)
        {
            device_->write(force_n);
        }
        return device_->read();
    }

private:
    std::unique_ptr<SimulatedDevice> device_ =
        std::move(SimulatedDevice::create({}, std::make_unique<HandAtRest>())).value();
};

/// Times that no stall of the machine reaches, for what is about something else.
inline RemoteTimes patient_times()
{
    return {milliseconds(60'000), milliseconds(60'000)};
}

/// A UdpDevice, and at the other end a simulated one, in lock step.
class UdpRig final : public DeviceRig
{
public:
    explicit UdpRig(const DeviceFrame& frame = {})
    {
        UdpDeviceOptions options;
        options.times = patient_times();
        options.frame = frame;
        options.clock = &clock_;
        peer_.describe(hand_.info());
        device_ = std::move(UdpDevice::create(std::move(socket_), options)).value();
    }

    [[nodiscard]] HapticDevice& device() noexcept override { return *device_; }
    [[nodiscard]] DeviceSample next() override
    {
        const udp::ForceDatagram force = peer_.ask();
        const DeviceSample sample = hand_.next(force.state, force.force_n);
        peer_.say({{},
                   sample.position_world_m,
                   sample.velocity_world_m_per_s,
                   sample.time.ns,
                   sample.valid,
                   sample.deadman_held});
        return device_->read();
    }

private:
    PosixClock clock_;
    ObedientDevice hand_;
    udp::Socket socket_ = std::move(udp::Socket::open("127.0.0.1", 0)).value();
    UdpPeer peer_{socket_.endpoint(), 7};
    std::unique_ptr<UdpDevice> device_;
};

} // namespace tactus::test
