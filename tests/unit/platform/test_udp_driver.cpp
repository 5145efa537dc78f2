// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/udp_device.hpp"
#include "platform/machine/posix/posix_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tactus
{
namespace
{

bool has_python()
{
    return std::system("python3 -c 'import sys; sys.exit(sys.version_info < (3, 8))' "
                       "2>/dev/null") == 0;
}

/// Driver that runs until stop() or the destructor kills it.
struct Driver
{
    Driver(const std::string& script, std::uint16_t port)
    {
        const std::string text = std::to_string(port); // Converted here: a child must not allocate.
        id_ = fork();
        if (id_ == 0)
        {
            execlp("python3", "python3", script.c_str(), text.c_str(), nullptr);
            _exit(127);
        }
    }
    Driver(const Driver&) = delete;
    Driver& operator=(const Driver&) = delete;
    ~Driver() { stop(); }

    void stop()
    {
        if (id_ > 0)
        {
            EXPECT_EQ(kill(id_, SIGKILL), 0);
            EXPECT_EQ(waitpid(id_, nullptr, 0), id_);
        }
        id_ = -1;
    }

private:
    pid_t id_{-1};
};

/// Reads and writes until the hand is at force / 200 N/m.
void push_to(UdpDevice& device, const std::array<double, 3>& force_n, double wanted_m)
{
    DeviceSample sample;
    do
    {
        std::this_thread::yield();
        sample = device.read();
        device.write({force_n, {}, 0.0});
    } while (!sample.valid || std::abs(sample.position_world_m[1] - wanted_m) > 1e-3);
    EXPECT_TRUE(sample.velocity_world_m_per_s);
    EXPECT_TRUE(sample.deadman_held);
}

/// Reads and writes until the hand is at torque / 0.5 N m.
void turn_to(UdpDevice& device, const std::array<double, 3>& torque_nm, double wanted_rad)
{
    double turned_rad = 0.0;
    do
    {
        std::this_thread::yield();
        const DeviceSample sample = device.read();
        device.write({{}, torque_nm, 0.0});
        turned_rad = sample.rotation_world ? 2.0 * std::asin((*sample.rotation_world)[1]) : 0.0;
    } while (std::abs(turned_rad - wanted_rad) > 1e-3);
}

TEST(UdpDriver, of_the_examples_attaches_obeys_dies_and_attaches_again)
{
    if (!has_python())
    {
        GTEST_SKIP() << "no python3 of version 3.8 or later here";
    }
    const std::string script = TACTUS_SOURCE_DIR "/docs/examples/udp_driver.py";
    const PosixClock clock;
    UdpDeviceOptions options;
    options.clock = &clock;
    options.wait = milliseconds(120'000); // Time for the machine to start an interpreter.
    options.times.silence = milliseconds(200);
    auto socket = std::move(udp::Socket::open("127.0.0.1", 0)).value();
    const std::uint16_t port = socket.endpoint().port;

    Driver first(script, port);
    auto made = UdpDevice::create(std::move(socket), options);
    ASSERT_TRUE(made) << made.error().text;
    UdpDevice& sut = *made.value();
    EXPECT_EQ(sut.info().name, "python");
    EXPECT_EQ(sut.info().limits.force_max_n, 8.0);
    EXPECT_EQ(sut.info().workspace_radius_m, 0.2);
    EXPECT_EQ(sut.info().rate_max_hz, 4'000);
    EXPECT_EQ(sut.info().limits.rotation.torque_max_nm, 0.2);
    EXPECT_TRUE(sut.info().limits.rotation.is_measured);
    turn_to(sut, {0.0, 0.05, 0.0}, 0.1);
    push_to(sut, {0.0, 2.0, 0.0}, 0.01);
    push_to(sut, {0.0, -4.0, 0.0}, -0.02);

    first.stop();
    while (sut.read().connected)
    {
        std::this_thread::yield();
    }
    EXPECT_FALSE(sut.read().valid);
    const std::uint64_t sessions = sut.traffic().sessions;
    const Driver second(script, port);
    push_to(sut, {0.0, 2.0, 0.0}, 0.01);
    EXPECT_GT(sut.traffic().sessions, sessions);
    const UdpTraffic traffic = sut.traffic();
    EXPECT_EQ(traffic.refused.at(static_cast<std::size_t>(udp::DatagramFault::checksum)), 0U);
    EXPECT_EQ(traffic.refused.at(static_cast<std::size_t>(udp::DatagramFault::content)), 0U);
}

} // namespace
} // namespace tactus
