// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/remote/remote_device.hpp"
#include "platform/devices/remote/remote_values.hpp"
#include "platform/devices/simulated/simulated_periodic_timer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace tactus
{
namespace
{

DeviceInfo some_device()
{
    DeviceInfo info;
    info.name = "some";
    info.limits.force_max_n = 10.0;
    info.workspace_radius_m = 0.2;
    info.speed_max_m_per_s = 5.0;
    info.rate_min_hz = 100;
    info.rate_max_hz = 4'000;
    return info;
}

/// Both halves on one thread, in virtual time.
struct TwoHalves : RemoteDevice
{
    explicit TwoHalves(const Clock& clock) : RemoteDevice(some_device(), {}, {}, clock) {}

    using RemoteDevice::command;
    using RemoteDevice::detach;
    using RemoteDevice::publish;
};

struct RemoteDeviceTest : testing::Test
{
    void arrive(double x_m, bool is_new = false, bool valid = true)
    {
        DeviceReading reading;
        reading.position_m = Vec3(x_m, 0.0, 0.0);
        reading.time = clock.now() - microseconds(300);
        reading.arrival = clock.now();
        reading.valid = valid;
        sut.publish(reading, is_new);
    }

    /// Attaches a device, and makes 1 N along x.
    void attach_and_write()
    {
        arrive(0.0, true);
        static_cast<void>(sut.read());
        sut.write({{1.0, 0.0, 0.0}, {}, 0.0});
    }

    SimulatedClock clock{MonotonicTime{1'000'000'000}};
    TwoHalves sut{clock};
};

TEST_F(RemoteDeviceTest, is_not_connected_before_the_first_reading)
{
    const DeviceSample sample = sut.read();
    EXPECT_FALSE(sample.connected);
    EXPECT_FALSE(sample.valid);
    sut.write({{1.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut.status().state, DeviceState::idle);
    EXPECT_EQ(sut.command().state, DeviceState::idle);
}

TEST_F(RemoteDeviceTest, gives_the_newest_reading_again_with_its_own_time)
{
    arrive(0.25, true);
    const MonotonicTime taken = clock.now() - microseconds(300);
    for (std::uint64_t frame = 0; frame < 3; ++frame)
    {
        const DeviceSample sample = sut.read();
        EXPECT_TRUE(sample.connected);
        EXPECT_TRUE(sample.valid);
        EXPECT_EQ(sample.position_world_m[0], 0.25);
        EXPECT_EQ(sample.time, taken);
        EXPECT_EQ(sample.frame, frame);
        EXPECT_FALSE(sample.velocity_world_m_per_s);
        clock.advance(milliseconds(1));
    }
}

TEST_F(RemoteDeviceTest, is_gone_after_20_ms_of_silence_and_not_before)
{
    arrive(0.25, true);
    clock.advance(milliseconds(20));
    EXPECT_TRUE(sut.read().connected);
    clock.advance(nanoseconds(1));
    const DeviceSample gone = sut.read();
    EXPECT_FALSE(gone.connected);
    EXPECT_FALSE(gone.valid);
    EXPECT_EQ(gone.position_world_m[0], 0.25);
    arrive(0.5);
    EXPECT_TRUE(sut.read().connected);
}

TEST_F(RemoteDeviceTest, is_gone_at_once_when_that_is_known)
{
    arrive(0.25, true);
    sut.detach();
    EXPECT_FALSE(sut.read().connected);
}

TEST_F(RemoteDeviceTest, keeps_the_last_good_position_beside_an_invalid_reading)
{
    arrive(0.25, true);
    clock.advance(milliseconds(1));
    arrive(77.0, false, false);
    const DeviceSample sample = sut.read();
    EXPECT_TRUE(sample.connected);
    EXPECT_FALSE(sample.valid);
    EXPECT_EQ(sample.position_world_m[0], 0.25);
}

TEST_F(RemoteDeviceTest, ends_the_force_of_a_haptic_thread_that_hangs)
{
    arrive(0.0, true);
    static_cast<void>(sut.read());
    sut.write({{1.0, 2.0, 3.0}, {}, 0.0});
    clock.advance(milliseconds(20) - nanoseconds(1));
    EXPECT_EQ(sut.status().state, DeviceState::force);
    EXPECT_EQ(sut.command().state, DeviceState::force);
    EXPECT_EQ(sut.command().force_n, Vec3(1.0, 2.0, 3.0));
    clock.advance(nanoseconds(1));
    EXPECT_EQ(sut.status().state, DeviceState::idle);
    EXPECT_EQ(sut.command().state, DeviceState::idle);
    EXPECT_EQ(sut.command().force_n, Vec3(0.0, 0.0, 0.0));
}

TEST_F(RemoteDeviceTest, never_sends_a_force_to_another_attachment_than_it_was_written_for)
{
    attach_and_write();
    arrive(0.0, true); // Another device, before the haptic thread has seen it.
    EXPECT_EQ(sut.command().state, DeviceState::idle);
    sut.write({{1.0, 0.0, 0.0}, {}, 0.0}); // A command for the previous device.
    EXPECT_EQ(sut.command().state, DeviceState::idle);
    static_cast<void>(sut.read());
    EXPECT_EQ(sut.status().state, DeviceState::idle);
    sut.write({{1.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut.command().state, DeviceState::force);
    EXPECT_EQ(sut.status().state, DeviceState::force);
}

TEST_F(RemoteDeviceTest, sends_the_brake_until_its_release_and_then_nothing_from_before)
{
    attach_and_write();
    EXPECT_EQ(sut.command().state, DeviceState::force);
    sut.brake();
    EXPECT_EQ(sut.command().state, DeviceState::brake);
    EXPECT_EQ(sut.command().force_n, Vec3(0.0, 0.0, 0.0));
    sut.write({{2.0, 0.0, 0.0}, {}, 0.0});
    sut.release_brake();
    EXPECT_EQ(sut.command().state, DeviceState::idle);
    EXPECT_EQ(sut.status().state, DeviceState::idle);
    sut.write({{3.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut.command().force_n, Vec3(3.0, 0.0, 0.0));
}

TEST_F(RemoteDeviceTest, fades_softly_whatever_the_hold_and_goes_on_with_the_next_write)
{
    attach_and_write();
    clock.advance(milliseconds(10));
    sut.brake_softly();
    for (int ms = 0; ms < 50; ++ms)
    {
        const DeviceCommand command = sut.command();
        EXPECT_EQ(command.state, DeviceState::force);
        EXPECT_NEAR(command.force_n.x(), 1.0 - ms / 50.0, 1e-9);
        // The command is new and will be sent.
        EXPECT_TRUE(ms == 0 || command.written == clock.now());
        EXPECT_EQ(sut.status().state, DeviceState::brake);
        arrive(0.0);
        static_cast<void>(sut.read());
        EXPECT_NEAR(sut.status().force_left, 1.0 - ms / 50.0, 1e-9);
        sut.write({{7.0, 0.0, 0.0}, {}, 0.0}); // Ignored.
        clock.advance(milliseconds(1));
    }
    EXPECT_EQ(sut.command().state, DeviceState::brake);
    EXPECT_EQ(sut.status().force_left, 0.0);
    sut.release_brake();
    EXPECT_EQ(sut.command().state, DeviceState::idle);

    sut.write({{1.0, 0.0, 0.0}, {}, 0.0});
    sut.brake_softly();
    clock.advance(milliseconds(20));
    sut.release_brake(); // The force fades until the next write.
    EXPECT_NEAR(sut.command().force_n.x(), 0.6, 1e-9);
    sut.write({{0.5, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut.command().force_n.x(), 0.5);
    EXPECT_EQ(sut.status().state, DeviceState::force);

    sut.brake_softly();
    sut.release_brake();
    sut.brake(); // Immediate brake after the release.
    sut.write({{0.5, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut.command().state, DeviceState::brake);
    EXPECT_EQ(sut.status().force_left, 0.0);
}

/// More threads than processors, so that the haptic thread is sometimes stopped during a write: the
/// I/O thread must not return to data from before the brake. A fault here is rare.
TEST_F(RemoteDeviceTest, brings_no_force_back_from_before_a_release_with_threads_that_are_stopped)
{
    constexpr int kRounds = 2'000'000;
    arrive(0.0, true);
    static_cast<void>(sut.read());
    std::atomic<int> released{0};
    std::atomic<bool> is_over{false};
    std::atomic<int> faults{0};
    const auto be_busy = [&]
    {
        while (!is_over)
        {
        }
    };
    std::thread busy(be_busy);
    std::thread busier(be_busy);
    std::thread io(
        [&]
        {
            while (!is_over)
            {
                const int before = released;
                const DeviceCommand now = sut.command();
                faults +=
                    now.state == DeviceState::force && now.force_n.x() * kRounds < before - 0.5 ? 1
                                                                                                : 0;
            }
        });
    for (int round = 1; round <= kRounds; ++round)
    {
        sut.brake();
        sut.release_brake();
        released = round;
        sut.write({{static_cast<double>(round) / kRounds, 0.0, 0.0}, {}, 0.0});
    }
    is_over = true;
    io.join();
    busy.join();
    busier.join();
    EXPECT_EQ(faults, 0);
}

TEST_F(RemoteDeviceTest, tells_each_write_from_the_one_before)
{
    attach_and_write();
    const MonotonicTime first = sut.command().written;
    clock.advance(milliseconds(1));
    sut.write({{1.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_GT(sut.command().written, first);
}

TEST(RemoteTimes, are_refused_out_of_range)
{
    EXPECT_EQ(find_bad_time({}), "");
    EXPECT_EQ(find_bad_time({milliseconds(1), milliseconds(60'000)}), "");
    EXPECT_NE(find_bad_time({Duration{999'999}, milliseconds(20)}), "");
    EXPECT_NE(find_bad_time({milliseconds(20), milliseconds(60'001)}), "");
}

TEST(InfoFault, finds_each_value_that_is_out_of_range)
{
    EXPECT_EQ(find_fault(some_device()), nullptr);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::function<void(DeviceInfo&)>> spoils{
        [](DeviceInfo& info) { info.name = ""; },
        [](DeviceInfo& info) { info.name = std::string(32, 'x'); },
        [](DeviceInfo& info) { info.name = "bell\a"; },
        [](DeviceInfo& info) { info.name = "\xC3\xA9"; },
        [](DeviceInfo& info) { info.limits.mass_kg = 0.0; },
        [nan](DeviceInfo& info) { info.limits.damping_n_s_per_m = nan; },
        [](DeviceInfo& info) { info.limits.force_max_n = 1'000.1; },
        [](DeviceInfo& info) { info.limits.delay_s = 0.11; },
        [nan](DeviceInfo& info) { info.workspace_centre_world_m[1] = nan; },
        [](DeviceInfo& info) { info.workspace_centre_world_m[2] = -10'001.0; },
        [](DeviceInfo& info) { info.workspace_radius_m = 0.0; },
        [nan](DeviceInfo& info) { info.workspace_radius_m = nan; },
        [](DeviceInfo& info) { info.speed_max_m_per_s = 1'001.0; },
        [](DeviceInfo& info) { info.rate_min_hz = 0; },
        [](DeviceInfo& info) { info.rate_max_hz = 99; },
        [](DeviceInfo& info) { info.rate_max_hz = 100'001; }};
    for (std::size_t i = 0; i < spoils.size(); ++i)
    {
        DeviceInfo info = some_device();
        spoils[i](info);
        EXPECT_NE(find_fault(info), nullptr) << "spoil " << i;
    }
}

} // namespace
} // namespace tactus
