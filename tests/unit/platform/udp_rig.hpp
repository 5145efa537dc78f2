// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"
#include "platform/devices/udp/socket.hpp"
#include "platform/devices/udp/udp_device.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "tests/unit/platform/device_rig.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>

namespace tactus::test
{

/// Protocol side of a device program. It has no time limits, so that tests do not depend on the
/// machine's speed.
struct UdpPeer
{
    UdpPeer(const udp::Endpoint& controller, std::uint64_t instance)
        : controller_(controller), instance_(instance)
    {
    }

    void describe(const DeviceInfo& info)
    {
        info_ = info;
        send(udp::encode(udp::DescribeDatagram{{instance_, 0, ++sequence_}, info}));
    }
    void send(std::span<const std::byte> bytes) { ASSERT_TRUE(socket_.send(bytes, controller_)); }
    void sample(udp::SampleDatagram datagram)
    {
        datagram.address = {instance_, session_, ++sequence_};
        send(udp::encode(datagram));
    }

    /// Present command to the device: the answer to a question sent after all earlier actions of
    /// the caller.
    [[nodiscard]] udp::ForceDatagram ask()
    {
        return until_answered([this] { describe(info_); });
    }
    /// Sends a sample and waits for its arrival.
    void say(const udp::SampleDatagram& datagram)
    {
        static_cast<void>(until_answered([&] { sample(datagram); }));
    }
    /// Next force datagram, if it arrives in time.
    [[nodiscard]] std::optional<udp::ForceDatagram> receive(Duration time)
    {
        std::array<std::byte, udp::kDatagramBytesMax + 1> buffer{};
        auto received = socket_.receive(buffer);
        if (!received)
        {
            socket_.wait(time);
            received = socket_.receive(buffer);
        }
        if (!received)
        {
            return std::nullopt;
        }
        EXPECT_EQ(received->from, controller_);
        const auto decoded = udp::decode_from_controller(std::span(buffer).first(received->bytes));
        EXPECT_TRUE(std::holds_alternative<udp::ForceDatagram>(decoded));
        const auto& force = std::get<udp::ForceDatagram>(decoded);
        EXPECT_EQ(force.address.instance, instance_);
        session_ = force.address.session;
        return force;
    }

    [[nodiscard]] std::uint64_t instance() const noexcept { return instance_; }
    void set_session(std::uint64_t session) noexcept { session_ = session; }
    void set_sequence(std::uint64_t sequence) noexcept { sequence_ = sequence; }

private:
    template <typename Send>
    udp::ForceDatagram until_answered(const Send& put)
    {
        for (;;)
        {
            put();
            while (const auto force = receive(milliseconds(100)))
            {
                if (force->answers == sequence_)
                {
                    return *force;
                }
            }
        }
    }

    udp::Socket socket_ = std::move(udp::Socket::open("127.0.0.1", 0)).value();
    udp::Endpoint controller_;
    std::uint64_t instance_;
    std::uint64_t session_{0};
    std::uint64_t sequence_{0};
    DeviceInfo info_;
};

/// Simulated device that follows the protocol's commands.
struct ObedientDevice
{
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
struct UdpRig final : DeviceRig
{
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
