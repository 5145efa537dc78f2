// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/replay_device.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace tactus
{

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Four readings with their own times; the second is invalid and the third is NaN.
ReplayDeviceOptions four_readings()
{
    ReplayDeviceOptions options;
    options.rate_hz = 4'000;
    options.limits.force_max_n = 2.0;
    const auto add = [&options](const std::array<double, 3>& position_m, std::int64_t time_ns)
    {
        DeviceSample reading;
        reading.position_world_m = position_m;
        reading.time = MonotonicTime{time_ns};
        reading.valid = true;
        options.readings.push_back(reading);
    };
    add({1.0, 0.0, 0.0}, 5);
    add({9.0, 9.0, 9.0}, 7);
    add({kNan, 0.0, 0.0}, 9);
    add({1.0, 0.5, -0.5}, 500);
    options.readings[1].valid = false;
    options.readings[3].rotation_world = {0.6, 0.0, 0.0, 0.8};
    options.readings[3].velocity_world_m_per_s = {1.0, 2.0, 3.0};
    options.readings[3].angular_velocity_world_rad_per_s = {4.0, 5.0, 6.0};
    options.readings[3].buttons = 5;
    options.readings[3].gripper_m = 0.03;
    return options;
}

std::unique_ptr<ReplayDevice> make(ReplayDeviceOptions options)
{
    return std::move(ReplayDevice::create(std::move(options))).value();
}

TEST(ReplayDevice, gives_each_reading_as_it_was_recorded_whatever_is_written)
{
    auto sut = make(four_readings());
    const std::vector<DeviceSample> recorded = four_readings().readings;
    for (std::size_t i = 0; i < recorded.size(); ++i)
    {
        const DeviceSample sample = sut->read();
        EXPECT_EQ(sample.frame, i);
        EXPECT_EQ(sample.time, recorded[i].time);
        EXPECT_EQ(sample.valid, recorded[i].valid);
        EXPECT_TRUE(sample.connected);
        EXPECT_TRUE(sample.deadman_held);
        EXPECT_EQ(sample.velocity_world_m_per_s, recorded[i].velocity_world_m_per_s);
        EXPECT_EQ(sample.rotation_world, recorded[i].rotation_world);
        EXPECT_EQ(sample.angular_velocity_world_rad_per_s,
                  recorded[i].angular_velocity_world_rad_per_s);
        EXPECT_EQ(sample.buttons, recorded[i].buttons);
        EXPECT_EQ(sample.gripper_m, recorded[i].gripper_m);
        EXPECT_EQ(std::isnan(sample.position_world_m[0]), i == 2);
        EXPECT_EQ(sample.position_world_m[1], recorded[i].position_world_m[1]);
        sut->write({{-1.0, 0.3, 0.2}, {}, 0.0});
    }
}

TEST(ReplayDevice, is_disconnected_after_the_last_reading_and_makes_no_force)
{
    auto sut = make(four_readings());
    DeviceSample last;
    for (int i = 0; i < 4; ++i)
    {
        last = sut->read();
        sut->write({{1.0, 0.0, 0.0}, {}, 0.0});
        EXPECT_EQ(sut->status().state, DeviceState::force);
    }
    for (std::uint64_t frame = 4; frame < 8; ++frame)
    {
        const DeviceSample sample = sut->read();
        EXPECT_FALSE(sample.connected);
        EXPECT_FALSE(sample.valid);
        EXPECT_EQ(sample.frame, frame);
        EXPECT_EQ(sample.position_world_m, last.position_world_m);
        sut->write({{1.0, 0.0, 0.0}, {}, 0.0});
        EXPECT_EQ(sut->status().state, DeviceState::idle);
    }
    sut->brake();
    EXPECT_EQ(sut->status().state, DeviceState::brake);
}

TEST(ReplayDevice, describes_a_workspace_round_what_was_recorded_and_the_rate_of_it)
{
    const auto sut = make(four_readings());
    const DeviceInfo& info = sut->info();
    EXPECT_EQ(info.workspace_centre_world_m, (std::array{1.0, 0.25, -0.25}));
    EXPECT_NEAR(info.workspace_radius_m, std::sqrt(0.5) / 2.0, 1e-15);
    EXPECT_EQ(info.rate_min_hz, 4'000);
    EXPECT_EQ(info.rate_max_hz, 4'000);
    EXPECT_EQ(info.limits.force_max_n, 2.0);
}

TEST(ReplayDevice, refuses_what_is_no_recording_of_a_hand)
{
    const auto refusal = [](auto&& spoil)
    {
        ReplayDeviceOptions options = four_readings();
        spoil(options);
        const auto made = ReplayDevice::create(std::move(options));
        return made ? std::string() : made.error().text;
    };
    const auto has = [](const std::string& text, const char* part)
    { return text.find(part) != std::string::npos; };
    EXPECT_EQ(refusal([](ReplayDeviceOptions&) {}), "");
    EXPECT_TRUE(has(refusal([](auto& o) { o.readings.clear(); }), "no readings"));
    EXPECT_TRUE(has(refusal(
                        [](auto& o) {
                            o.readings = {o.readings[1], o.readings[2]};
                        }),
                    "no reading has a valid position"));
    EXPECT_TRUE(has(refusal([](auto& o) { o.rate_hz = 0; }), "above 0 Hz"));
    for (const double bad : {0.0, -1.0, kNan})
    {
        EXPECT_TRUE(has(refusal([&](auto& o) { o.limits.force_max_n = bad; }), "largest force"));
        EXPECT_TRUE(has(refusal([&](auto& o) { o.speed_max_m_per_s = bad; }), "largest force"));
    }
}

} // namespace

} // namespace tactus
