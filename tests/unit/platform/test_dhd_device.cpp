// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/dhd/dhd_guard.hpp"
#include "tests/unit/platform/dhd_rig.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

namespace tactus
{
namespace
{

using test::LoadedStandIn;
using test::StandInDhdDevice;

struct DhdDeviceTest : testing::Test
{
    DhdDeviceTest()
    {
        options.library = TACTUS_STAND_IN_DHD;
        options.clock = &clock;
        options.times = test::patient_times();
    }

    std::string refusal()
    {
        const auto refused = DhdDevice::create(options);
        EXPECT_FALSE(refused);
        if (refused)
        {
            return "";
        }
        EXPECT_EQ(refused.error().text.find('\n'), std::string::npos);
        return refused.error().text;
    }
    bool refusal_has(const char* text) { return refusal().find(text) != std::string::npos; }
    void open() { sut = std::move(DhdDevice::create(options)).value(); }
    StandInDhdDevice& hand() { return stand_in->devices.at(0); }
    /// Reads until the sample satisfies the condition.
    template <typename Wanted>
    DeviceSample await(const Wanted& is_wanted)
    {
        for (;;)
        {
            const DeviceSample sample = sut->read();
            if (is_wanted(sample))
            {
                return sample;
            }
            std::this_thread::yield();
        }
    }
    void open_and_write(const Wrench& wrench)
    {
        open();
        await([](const DeviceSample& sample) { return sample.valid; });
        sut->write(wrench);
        await_turn();
    }
    /// Present output of the motors, and the commands.
    struct Motors
    {
        std::array<double, 3> force_n;
        std::array<double, 3> torque_nm;
        double grip_n;
        bool brakes;
        bool forces_enabled;
    };
    Motors motors()
    {
        const std::lock_guard lock(hand().mutex);
        return {hand().force_n, hand().torque_nm, hand().grip_n, hand().brakes,
                hand().forces_enabled};
    }
    void await_turn() { test::await_turn(hand()); }

    PosixClock clock;
    LoadedStandIn stand_in;
    DhdDeviceOptions options;
    std::unique_ptr<DhdDevice> sut;
};

TEST_F(DhdDeviceTest, says_in_one_line_that_the_sdk_is_missing)
{
    options.library = "/nowhere/libdhd.so";
    EXPECT_TRUE(refusal_has("dhd device: the SDK can't be loaded (/nowhere/libdhd.so"));
}

TEST_F(DhdDeviceTest, says_in_one_line_which_function_is_missing)
{
    options.library = TACTUS_OLD_STAND_IN_DHD;
    EXPECT_TRUE(refusal_has("has no function dhdSetForceAndTorqueAndGripperForce; Force "
                            "Dimension's SDK 3 is required"));
}

TEST_F(DhdDeviceTest, says_in_one_line_that_no_device_is_there_or_can_be_opened)
{
    stand_in->count = 0;
    EXPECT_TRUE(refusal_has("the SDK finds no device; check the cable"));
    stand_in->count = 2;
    options.index = 2;
    EXPECT_TRUE(refusal_has("there is no device 2; the devices are 0..1"));
    stand_in->count = 8;
    options.index = 0;
    hand().is_open = true; // Open in another program.
    EXPECT_TRUE(refusal_has("device 0 can't be opened (device in use)"));
}

TEST_F(DhdDeviceTest, refuses_options_out_of_range)
{
    const DhdDeviceOptions good = options;
    options.index = 64;
    EXPECT_TRUE(refusal_has("0..63"));
    options = good;
    options.period = microseconds(99);
    EXPECT_TRUE(refusal_has("100 us..10 ms"));
    options = good;
    options.deadman_button = 16;
    EXPECT_TRUE(refusal_has("0..15"));
    options = good;
    options.times.force_hold = Duration{};
    EXPECT_TRUE(refusal_has("1 ms..60 s"));
    options = good;
    options.info.limits.mass_kg = 0.0;
    EXPECT_TRUE(refusal_has("mass_kg"));
    EXPECT_FALSE(hand().is_open) << "it is closed again";
}

TEST_F(DhdDeviceTest, is_called_what_the_sdk_or_the_user_says)
{
    open();
    EXPECT_EQ(sut->info().name, "stand-in") << "without what can't be shown";
    sut.reset();
    options.info.name = "left hand";
    open();
    EXPECT_EQ(sut->info().name, "left hand");
}

TEST_F(DhdDeviceTest, reads_position_velocity_and_button)
{
    options.deadman_button = 1;
    hand().position_m = {0.01, 0.02, 0.03};
    hand().velocity = {1.0, 2.0, 3.0};
    open();
    const DeviceSample free = await([](const DeviceSample& sample) { return sample.connected; });
    EXPECT_TRUE(free.valid);
    EXPECT_FALSE(free.deadman_held);
    EXPECT_EQ(free.position_world_m, (std::array{0.01, 0.02, 0.03}));
    EXPECT_EQ(free.velocity_world_m_per_s, (std::array{1.0, 2.0, 3.0}));
    {
        const std::lock_guard lock(hand().mutex);
        hand().buttons.at(1) = 1;
    }
    hand().has_velocity = false;
    await([](const auto& sample) { return sample.deadman_held && !sample.velocity_world_m_per_s; });
}

TEST_F(DhdDeviceTest, turns_and_grips)
{
    hand().frame = {0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}; // Quarter turn about z.
    hand().turning = {4.0, 5.0, 6.0};
    hand().gap_m = 0.02;
    hand().has_gripper = true;
    hand().buttons = {1, 1};
    open();
    const DeviceSample sample = await([](const auto& got) { return got.valid; });
    EXPECT_NEAR((*sample.rotation_world)[2], std::sqrt(0.5), 1e-12);
    EXPECT_NEAR((*sample.rotation_world)[3], std::sqrt(0.5), 1e-12);
    EXPECT_EQ(sample.angular_velocity_world_rad_per_s, (std::array{4.0, 5.0, 6.0}));
    EXPECT_EQ(sample.gripper_m, 0.02);
    EXPECT_EQ(sample.buttons, 3U);
    sut->write({{1.0, 2.0, 3.0}, {0.01, 0.02, 0.03}, 0.5});
    await_turn();
    EXPECT_EQ(motors().torque_nm, (std::array{0.01, 0.02, 0.03}));
    EXPECT_EQ(motors().grip_n, 0.5);
    {
        const std::lock_guard lock(hand().mutex);
        hand().frame.at(0) = 1.0; // No longer a rotation.
    }
    EXPECT_TRUE(await([](const auto& got) { return !got.valid; }).connected);
}

TEST_F(DhdDeviceTest, without_a_wrist_or_its_motors_makes_the_force_alone)
{
    hand().has_active_wrist = false;
    open_and_write({{1.0, 2.0, 3.0}, {0.01, 0.02, 0.03}, 0.5});
    EXPECT_TRUE(sut->info().limits.rotation.is_measured);
    EXPECT_EQ(sut->info().limits.rotation.torque_max_nm, 0.0);
    EXPECT_EQ(sut->info().gripper_force_max_n, 0.0);
    EXPECT_EQ(motors().force_n, (std::array{1.0, 2.0, 3.0}));
    EXPECT_EQ(motors().torque_nm, (std::array{0.0, 0.0, 0.0}));
    EXPECT_EQ(motors().grip_n, 0.0);
    sut.reset();
    hand().has_wrist = false;
    open();
    EXPECT_FALSE(sut->info().limits.rotation.is_measured);
    EXPECT_FALSE(await([](const auto& got) { return got.valid; }).rotation_world);
}

TEST_F(DhdDeviceTest, takes_no_position_that_is_no_number)
{
    hand().position_m = {0.01, 0.0, 0.0};
    open();
    await([](const DeviceSample& sample) { return sample.valid; });
    {
        const std::lock_guard lock(hand().mutex);
        hand().position_m.at(1) = std::numeric_limits<double>::quiet_NaN();
    }
    const DeviceSample lost = await([](const DeviceSample& sample) { return !sample.valid; });
    EXPECT_TRUE(lost.connected);
    EXPECT_EQ(lost.position_world_m, (std::array{0.01, 0.0, 0.0}));
}

TEST_F(DhdDeviceTest, sets_the_devices_own_brakes_where_there_are_some_and_takes_the_force_away)
{
    for (const bool has_brakes : {true, false})
    {
        hand().has_brakes = has_brakes;
        open_and_write({{1.0, 2.0, 3.0}, {}, 0.0});
        EXPECT_TRUE(!has_brakes || !motors().brakes);
        EXPECT_TRUE(motors().forces_enabled);
        EXPECT_EQ(motors().force_n, (std::array{1.0, 2.0, 3.0}));
        sut->brake();
        await_turn();
        EXPECT_TRUE(!has_brakes || motors().brakes);
        EXPECT_EQ(motors().force_n, (std::array{0.0, 0.0, 0.0}));
        EXPECT_TRUE(sut->read().connected);
        sut->release_brake();
        await_turn();
        EXPECT_TRUE(!has_brakes || !motors().brakes);
        EXPECT_EQ(motors().force_n, (std::array{0.0, 0.0, 0.0}));
        sut.reset();
    }
}

TEST_F(DhdDeviceTest, is_gone_when_unplugged_and_idle_when_it_is_back)
{
    open();
    await([](const DeviceSample& sample) { return sample.valid; });
    sut->write({{1.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut->status().state, DeviceState::force);
    hand().is_plugged_in = false;
    EXPECT_FALSE(await([](const DeviceSample& sample) { return !sample.connected; }).valid);
    EXPECT_EQ(sut->status().state, DeviceState::idle);
    hand().is_plugged_in = true;
    await([](const DeviceSample& sample) { return sample.valid; });
    EXPECT_EQ(sut->status().state, DeviceState::idle);
    await_turn();
    EXPECT_EQ(motors().force_n, (std::array{0.0, 0.0, 0.0}));
    EXPECT_TRUE(motors().forces_enabled);
}

TEST_F(DhdDeviceTest, sets_the_devices_own_watchdog_to_the_time_of_a_forces_hold)
{
    open_and_write({{1.0, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(hand().watchdog_steps, 255) << "no device takes a minute";
    sut.reset();
    options.times.force_hold = milliseconds(20);
    open();
    await([](const DeviceSample& sample) { return sample.valid; });
    await_turn();
    EXPECT_EQ(hand().watchdog_steps, 160);
}

TEST_F(DhdDeviceTest, is_braked_by_its_guard_when_its_program_has_left_it)
{
    const auto guard = DhdGuard::create(TACTUS_STAND_IN_DHD, 0);
    ASSERT_TRUE(guard);
    hand().force_n = {1.0, 2.0, 3.0};
    hand().brakes = false;
    hand().forces_enabled = true;
    hand().is_open = true; // Open for a program that has died, as the system is about to detect.
    std::thread closes(
        [this]
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            hand().is_open = false;
        });
    EXPECT_TRUE(guard.value()->brake());
    closes.join();
    EXPECT_EQ(hand().force_n, (std::array{0.0, 0.0, 0.0}));
    EXPECT_TRUE(hand().brakes);
    EXPECT_FALSE(hand().forces_enabled);
    EXPECT_FALSE(hand().is_open);
    const auto missing = DhdGuard::create("libnowhere.so", 0);
    ASSERT_FALSE(missing);
    EXPECT_TRUE(missing.error().text.starts_with("dhd device: the SDK can't be loaded"));
}

TEST_F(DhdDeviceTest, leaves_the_device_without_a_force_and_closed)
{
    open_and_write({{1.0, 0.0, 0.0}, {}, 0.0});
    sut.reset();
    EXPECT_EQ(hand().force_n, (std::array{0.0, 0.0, 0.0}));
    EXPECT_FALSE(hand().forces_enabled);
    EXPECT_FALSE(hand().is_open);
}

} // namespace
} // namespace tactus
