// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"
#include "platform/devices/udp/socket.hpp"

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
class UdpPeer
{
public:
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

} // namespace tactus::test
