// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/udp_device.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "tests/unit/platform/device_rig.hpp"
#include "tests/unit/platform/udp_peer.hpp"

namespace tactus::test
{

/// Simulated device that follows the protocol's commands.
class ObedientDevice
{
public:
    [[nodiscard]] const DeviceInfo& info() const noexcept { return device_->info(); }

    [[nodiscard]] DeviceSample next(DeviceState state, const Wrench& wrench)
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
            device_->write(wrench);
        }
        return device_->read();
    }

private:
    std::unique_ptr<SimulatedDevice> device_ =
        std::move(SimulatedDevice::create({}, std::make_unique<OperatorAtRest>())).value();
};

/// Times that no stall of the machine reaches, for tests of other properties.
inline RemoteTimes patient_times()
{
    return {milliseconds(60'000), milliseconds(60'000)};
}

/// UdpDevice with a simulated device at the other end, in lock step.
class UdpRig final : public DeviceRig
{
public:
    explicit UdpRig(const DeviceFrame& frame = {})
    {
        UdpDeviceOptions options;
        options.times = patient_times();
        options.proof = Duration{};
        options.frame = frame;
        options.clock = &clock_;
        peer_.describe(hand_.info());
        device_ = std::move(UdpDevice::create(std::move(socket_), options)).value();
    }

    [[nodiscard]] HapticDevice& device() noexcept override { return *device_; }
    [[nodiscard]] DeviceSample next() override
    {
        const udp::ForceDatagram force = peer_.ask();
        const DeviceSample sample =
            hand_.next(force.state, {force.force_n, force.torque_nm, force.gripper_force_n});
        udp::SampleDatagram said;
        said.position_m = sample.position_world_m;
        said.velocity_m_per_s = sample.velocity_world_m_per_s;
        said.time_ns = sample.time.ns;
        said.valid = sample.valid;
        said.deadman_held = sample.deadman_held;
        said.rotation = sample.rotation_world;
        said.angular_velocity_rad_per_s = sample.angular_velocity_world_rad_per_s;
        said.gripper_m = sample.gripper_m;
        said.buttons = sample.buttons;
        peer_.say(said);
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
