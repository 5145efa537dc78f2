// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/udp_device.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "tests/unit/platform/udp_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tactus
{
namespace
{

using test::UdpPeer;

udp::Socket any_socket()
{
    return std::move(udp::Socket::open("127.0.0.1", 0)).value();
}

DeviceInfo desk()
{
    DeviceInfo info;
    info.name = "desk";
    info.limits.delay_s = 0.001;
    info.workspace_radius_m = 0.1;
    info.speed_max_m_per_s = 5.0;
    info.rate_min_hz = 100;
    info.rate_max_hz = 4'000;
    return info;
}

struct UdpDeviceTest : testing::Test
{
    UdpDeviceTest()
    {
        options.clock = &clock;
        options.proof = Duration{};
    }

    /// Makes `peer` the device of `sut`.
    void attach()
    {
        peer.describe(desk());
        sut = std::move(UdpDevice::create(std::move(socket), options)).value();
    }
    /// Attaches, and reads the first sample.
    void attach_and_read()
    {
        options.times = test::patient_times();
        attach();
        static_cast<void>(peer.ask());
        peer.say(sample_at(0.0));
        static_cast<void>(sut->read());
    }
    udp::SampleDatagram sample_at(double x_m)
    {
        udp::SampleDatagram sample;
        sample.position_m = {x_m, 0.0, 0.0};
        sample.time_ns = ++device_ns;
        sample.valid = true;
        return sample;
    }
    /// Receives until a datagram satisfies the condition.
    template <typename Wanted>
    static udp::ForceDatagram await_force(UdpPeer& from, const Wanted& is_wanted)
    {
        for (;;)
        {
            const auto force = from.receive(milliseconds(100));
            if (force && is_wanted(*force))
            {
                return *force;
            }
        }
    }

    PosixClock clock;
    UdpDeviceOptions options;
    std::int64_t device_ns{0};
    udp::Socket socket = any_socket();
    udp::Endpoint controller = socket.endpoint();
    UdpPeer peer{controller, 11};
    std::unique_ptr<UdpDevice> sut;
};

TEST_F(UdpDeviceTest, refuses_options_out_of_range_in_one_line)
{
    const auto line_of = [](const UdpDeviceOptions& bad)
    {
        const auto refused = UdpDevice::create(bad);
        EXPECT_FALSE(refused);
        EXPECT_EQ(refused.error().text.find('\n'), std::string::npos);
        return refused.error().text;
    };
    UdpDeviceOptions bad = options;
    bad.address = "localhost";
    EXPECT_NE(line_of(bad).find("'localhost' is not a numeric IPv4 address"), std::string::npos);
    bad.address = "192.0.2.1"; // Unused address of RFC 5737.
    EXPECT_NE(line_of(bad).find("can't listen on 192.0.2.1:48500"), std::string::npos);
    bad = options;
    for (const int port : {-1, 80, 65'536})
    {
        bad.port = port;
        EXPECT_NE(line_of(bad).find("1024..65535"), std::string::npos);
    }
    bad.port = controller.port;
    EXPECT_NE(line_of(bad).find("EADDRINUSE"), std::string::npos);
    bad = options;
    bad.port = 0;
    bad.poll = microseconds(19);
    EXPECT_NE(line_of(bad).find("20 us..10 ms"), std::string::npos);
    bad.poll = options.poll;
    bad.wait = Duration{-1};
    EXPECT_NE(line_of(bad).find("0..3600 s"), std::string::npos);
    bad.wait = options.wait;
    bad.transport_delay = milliseconds(101);
    EXPECT_NE(line_of(bad).find("0..100 ms"), std::string::npos);
    bad.transport_delay = Duration{};
    bad.times.silence = Duration{};
    EXPECT_NE(line_of(bad).find("1 ms..60 s"), std::string::npos);
}

TEST_F(UdpDeviceTest, is_bound_to_this_machine_unless_told_otherwise)
{
    EXPECT_EQ(options.address, "127.0.0.1");
    EXPECT_EQ(controller.address, 0x7F00'0001U);
}

TEST_F(UdpDeviceTest, says_that_nobody_came_and_what_was_refused)
{
    options.wait = Duration{};
    const auto nobody = UdpDevice::create(any_socket(), options);
    ASSERT_FALSE(nobody);
    EXPECT_NE(nobody.error().text.find("no device described itself to 127.0.0.1:"),
              std::string::npos);
    peer.send(std::vector<std::byte>(96, std::byte{1}));
    options.wait = milliseconds(50);
    const auto rubbish = UdpDevice::create(std::move(socket), options);
    ASSERT_FALSE(rubbish);
    EXPECT_NE(rubbish.error().text.find("within 50 ms (1 datagram refused, the last: wrong "
                                        "magic)"),
              std::string::npos)
        << rubbish.error().text;
}

TEST_F(UdpDeviceTest, takes_the_limits_of_who_proves_to_be_there_not_of_who_was_first)
{
    options.proof = milliseconds(50);
    DeviceInfo lie = desk();
    lie.limits.force_max_n = 1'000.0;
    UdpPeer liar(controller, 12);
    liar.describe(lie);
    std::atomic<bool> is_done{false};
    std::thread driver(
        [&]
        {
            while (!is_done)
            {
                peer.receive(milliseconds(2)) ? peer.sample(sample_at(0.01))
                                              : peer.describe(desk());
            }
        });
    auto device = UdpDevice::create(std::move(socket), options);
    is_done = true;
    driver.join();
    ASSERT_TRUE(device) << device.error().text;
    EXPECT_EQ(device.value()->info().limits.force_max_n, desk().limits.force_max_n);
}

TEST_F(UdpDeviceTest, believes_nobody_while_two_say_to_be_the_device)
{
    options.times = test::patient_times();
    options.proof = milliseconds(50);
    options.wait = milliseconds(600);
    UdpPeer liar(controller, 12);
    std::atomic<bool> is_done{false};
    std::thread both(
        [&]
        {
            while (!is_done)
            {
                for (UdpPeer* each : {&liar, &peer})
                {
                    each->receive(milliseconds(2)) ? each->sample(sample_at(0.01))
                                                   : each->describe(desk());
                }
            }
        });
    const auto device = UdpDevice::create(std::move(socket), options);
    is_done = true;
    both.join();
    ASSERT_FALSE(device);
    EXPECT_NE(device.error().text.find("more than one device describes itself to 127.0.0.1:"),
              std::string::npos)
        << device.error().text;
    EXPECT_EQ(device.error().text.find('\n'), std::string::npos);
}

TEST_F(UdpDeviceTest, stops_waiting_when_it_is_told_to)
{
    options.wait = UdpDeviceOptions::kWaitMax;
    int asked = 0;
    options.goes_on = [&asked] { return ++asked < 3; };
    const auto nobody = UdpDevice::create(any_socket(), options);
    ASSERT_FALSE(nobody);
    EXPECT_EQ(asked, 3);
}

TEST_F(UdpDeviceTest, is_what_the_device_says_and_as_late_as_the_way)
{
    options.transport_delay = microseconds(400);
    attach();
    EXPECT_EQ(sut->info().name, "desk");
    EXPECT_EQ(sut->info().rate_max_hz, 4'000);
    EXPECT_DOUBLE_EQ(sut->info().limits.delay_s, 0.0014);
}

TEST_F(UdpDeviceTest, passes_on_what_a_sample_says)
{
    options.times = test::patient_times();
    attach();
    static_cast<void>(peer.ask());
    udp::SampleDatagram sample = sample_at(0.01);
    sample.velocity_m_per_s = {1.0, 2.0, 3.0};
    sample.deadman_held = false;
    peer.say(sample);
    const DeviceSample first = sut->read();
    EXPECT_EQ(first.position_world_m, (std::array{0.01, 0.0, 0.0}));
    EXPECT_EQ(first.velocity_world_m_per_s, (std::array{1.0, 2.0, 3.0}));
    EXPECT_TRUE(first.valid);
    EXPECT_FALSE(first.deadman_held);
    sample = sample_at(0.02);
    sample.valid = false;
    peer.say(sample);
    const DeviceSample second = sut->read();
    EXPECT_FALSE(second.valid);
    EXPECT_TRUE(second.deadman_held);
    EXPECT_EQ(second.position_world_m, first.position_world_m);
}

TEST_F(UdpDeviceTest, is_gone_when_the_device_is_silent_and_idle_when_another_is_there)
{
    attach();
    static_cast<void>(peer.ask());
    peer.say(sample_at(0.01));
    while (sut->read().connected || sut->traffic().lost == 0)
    {
        sut->write({{1.0, 0.0, 0.0}, {}, 0.0});
        std::this_thread::yield();
    }
    EXPECT_FALSE(sut->read().valid);
    EXPECT_EQ(sut->status().state, DeviceState::idle);
    const std::uint64_t lost = sut->traffic().lost;

    UdpPeer other(controller, 12);
    // Runs until it is connected: the machine's delay may make it silent for too long.
    while (!sut->read().connected)
    {
        other.describe(desk());
        if (other.receive(milliseconds(5)))
        {
            other.sample(sample_at(0.05));
        }
        std::this_thread::yield();
    }
    EXPECT_GE(sut->traffic().lost, lost);
    EXPECT_GE(sut->traffic().sessions, 2U);
    EXPECT_EQ(sut->read().position_world_m[0], 0.05);
    EXPECT_EQ(sut->status().state, DeviceState::idle) << "the force was for the one before";
    while (const auto force = other.receive(Duration{}))
    {
        EXPECT_EQ(force->state, DeviceState::idle);
        EXPECT_EQ(force->force_n, (std::array{0.0, 0.0, 0.0}));
    }
}

TEST_F(UdpDeviceTest, sends_the_brake_by_itself)
{
    attach_and_read();
    std::thread other([this] { sut->brake(); });
    other.join();
    // The I/O thread knows which sample it answers; brake() does not.
    const udp::ForceDatagram at_once =
        await_force(peer, [](const auto& force) { return force.answers == 0; });
    EXPECT_EQ(at_once.state, DeviceState::brake);
    EXPECT_EQ(at_once.force_n, (std::array{0.0, 0.0, 0.0}));
    EXPECT_EQ(peer.ask().state, DeviceState::brake) << "and the I/O thread goes on with it";
    sut->release_brake();
    EXPECT_EQ(peer.ask().state, DeviceState::idle);
}

/// Under any scheduling, the datagram with the greater number counts. The force contains its round,
/// and each round ends with one immediate brake.
TEST_F(UdpDeviceTest, sends_no_force_with_a_number_beyond_that_of_the_brake)
{
    constexpr int kRounds = 50'000;
    options.poll = UdpDeviceOptions::kPollMin;
    attach_and_read();
    std::vector<udp::ForceDatagram> seen;
    for (int round = 1; round <= kRounds; ++round)
    {
        sut->release_brake();
        for (int i = 0; i < round % 16; ++i)
        {
            sut->write({{round * 1e-5, 0.0, 0.0}, {}, 0.0});
        }
        sut->brake();
        while (const auto force = peer.receive(Duration{}))
        {
            seen.push_back(*force);
        }
    }
    std::ranges::sort(seen, {}, [](const auto& force) { return force.address.sequence; });
    int brakes = 0;
    int forces = 0;
    for (const udp::ForceDatagram& datagram : seen)
    {
        brakes += datagram.answers == 0 ? 1 : 0;
        if (datagram.state == DeviceState::force)
        {
            ++forces;
            EXPECT_GT(std::lround(datagram.force_n[0] * 1e5), brakes);
        }
    }
    EXPECT_EQ(brakes, kRounds);
    EXPECT_GT(forces, 0);
}

TEST_F(UdpDeviceTest, tells_the_device_to_be_idle_when_it_ends)
{
    attach_and_read();
    sut->write({{1.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(peer.ask().state, DeviceState::force);
    sut.reset();
    std::optional<udp::ForceDatagram> last;
    while (const auto force = peer.receive(Duration{}))
    {
        last = force;
    }
    ASSERT_TRUE(last);
    EXPECT_EQ(last->state, DeviceState::idle);
    EXPECT_EQ(last->force_n, (std::array{0.0, 0.0, 0.0}));
}

void print(const char* way, std::vector<Duration> times)
{
    std::ranges::sort(times);
    const auto at = [&](std::size_t percent)
    { return static_cast<double>(times[(times.size() - 1) * percent / 100].ns) * 1e-3; };
    std::printf("[ latency  ] %s: p50 %.0f us, p99 %.0f us, largest %.0f us\n", way, at(50), at(99),
                at(100));
}

/// Each way separately, over loopback. The figures are those of docs/udp-device.md; asserted is
/// that everything arrives.
TEST_F(UdpDeviceTest, tells_what_each_way_takes)
{
    constexpr int kRounds = 1'000;
    attach_and_read();
    std::vector<Duration> forces;
    std::vector<Duration> samples;
    const auto get_out_of_step = []
    { std::this_thread::sleep_for(std::chrono::microseconds(370)); };
    for (int round = 1; round <= kRounds; ++round)
    {
        const double value = round * 1e-3;
        const MonotonicTime written = clock.now();
        sut->write({{value, 0.0, 0.0}, {}, 0.0});
        static_cast<void>(
            await_force(peer, [value](const auto& force) { return force.force_n[0] == value; }));
        forces.push_back(clock.now() - written);
        get_out_of_step();
        const MonotonicTime sent = clock.now();
        peer.sample(sample_at(value));
        while (sut->read().position_world_m[0] != value)
        {
        }
        samples.push_back(clock.now() - sent);
        get_out_of_step();
    }
    print("a force, written to received", forces);
    print("a sample, sent to read", samples);
    EXPECT_EQ(sut->traffic().unsent, 0U);
}

/// The tool has no rotation, and is answered in its version.
TEST_F(UdpDeviceTest, of_version_1_is_answered_in_its_version)
{
    DeviceInfo old = desk();
    old.limits.rotation = {};
    udp::DescribeDatagram described{{peer.instance(), 0, 1}, old};
    described.version = udp::kVersionOfPoints;
    peer.set_sequence(1);
    peer.send(udp::encode(described));
    sut = std::move(UdpDevice::create(std::move(socket), options)).value();
    EXPECT_FALSE(sut->info().limits.rotation.is_measured);
    udp::ForceDatagram answer;
    for (bool is_answered = false; !is_answered;)
    {
        const auto force = peer.receive(milliseconds(100));
        is_answered = force.has_value();
        answer = force.value_or(answer);
    }
    EXPECT_EQ(answer.version, udp::kVersionOfPoints);
    udp::SampleDatagram sample = sample_at(0.25);
    sample.version = udp::kVersionOfPoints;
    peer.sample(sample);
    DeviceSample got;
    do
    {
        got = sut->read();
    } while (!got.valid);
    EXPECT_EQ(got.position_world_m[0], 0.25);
    EXPECT_FALSE(got.rotation_world);
}

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
