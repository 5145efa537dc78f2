// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/faulty_device.hpp"
#include "platform/devices/simulated/replay_device.hpp"
#include "tests/unit/platform/device_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace tactus
{
namespace
{

std::unique_ptr<SimulatedDevice> walking_device()
{
    return std::move(SimulatedDevice::create({}, test::operator_along_x(1e-3))).value();
}

std::vector<DeviceSample> readings(HapticDevice& device, std::size_t count = 30)
{
    std::vector<DeviceSample> samples(count);
    std::ranges::generate(samples, [&] { return device.read(); });
    return samples;
}

std::vector<DeviceSample> readings_with(std::vector<DeviceFault> faults, std::uint64_t seed = 1)
{
    FaultyDevice sut(walking_device(), std::move(faults), seed);
    return readings(sut);
}

/// Comparison bit for bit, with all NaN equal.
bool is_same(const DeviceSample& a, const DeviceSample& b)
{
    return a.position_world_m == b.position_world_m &&
           a.velocity_world_m_per_s == b.velocity_world_m_per_s && a.time == b.time &&
           a.frame == b.frame && a.valid == b.valid && a.connected == b.connected &&
           a.deadman_held == b.deadman_held;
}

const DeviceFaultKind kFaultKinds[] = {DeviceFaultKind::jitter,    DeviceFaultKind::dropout,
                                       DeviceFaultKind::stuck,     DeviceFaultKind::nan,
                                       DeviceFaultKind::time_jump, DeviceFaultKind::disconnect};

TEST(FaultyDevice, is_the_device_itself_but_from_begin_to_end_of_a_fault)
{
    const std::vector<DeviceSample> whole = readings(*walking_device());
    for (const DeviceFaultKind kind : kFaultKinds)
    {
        for (const DeviceFault fault : {DeviceFault{kind, 10, 5}, DeviceFault{kind, 1, 1},
                                        DeviceFault{kind, 29, 1'000'000'000}})
        {
            const std::vector<DeviceSample> sut = readings_with({fault});
            for (std::size_t i = 0; i < whole.size(); ++i)
            {
                // The velocity follows immediately.
                const bool leaps = kind == DeviceFaultKind::stuck;
                const bool holds = i >= fault.begin_frame &&
                                   i < fault.begin_frame + fault.frames + (leaps ? 1 : 0);
                EXPECT_EQ(is_same(sut[i], whole[i]), !holds) << static_cast<int>(kind) << " " << i;
            }
        }
    }
}

TEST(FaultyDevice, jitters_by_its_seed_within_the_bound)
{
    const std::vector<DeviceSample> whole = readings(*walking_device());
    const std::vector<DeviceFault> faults = {{DeviceFaultKind::jitter, 0, 30}};
    const std::vector<DeviceSample> one = readings_with(faults);
    const std::vector<DeviceSample> two = readings_with(faults);
    const std::vector<DeviceSample> other = readings_with(faults, 2);
    std::set<double> errors_m;
    for (std::size_t i = 0; i < whole.size(); ++i)
    {
        SCOPED_TRACE(i);
        EXPECT_TRUE(is_same(one[i], two[i]));
        EXPECT_FALSE(is_same(one[i], other[i]));
        EXPECT_TRUE(one[i].valid);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            errors_m.insert(one[i].position_world_m[axis] - whole[i].position_world_m[axis]);
        }
    }
    EXPECT_EQ(errors_m.size(), 90U);
    EXPECT_GE(*errors_m.begin(), -1.01e-4);
    EXPECT_LT(*errors_m.begin(), -0.8e-4);
    EXPECT_LE(*errors_m.rbegin(), 1.01e-4);
    EXPECT_GT(*errors_m.rbegin(), 0.8e-4);
}

TEST(FaultyDevice, a_dropout_repeats_the_last_good_reading_and_says_so)
{
    const std::vector<DeviceSample> sut = readings_with({{DeviceFaultKind::dropout, 10, 5}});
    for (std::size_t i = 10; i < 15; ++i)
    {
        EXPECT_FALSE(sut[i].valid);
        EXPECT_TRUE(sut[i].connected);
        EXPECT_EQ(sut[i].frame, i);
        EXPECT_EQ(sut[i].position_world_m, sut[9].position_world_m);
        EXPECT_EQ(sut[i].time, sut[9].time);
    }
}

TEST(FaultyDevice, stuck_encoders_look_as_a_hand_at_rest_that_leaps_at_last)
{
    for (const std::uint64_t begin : {0U, 10U})
    {
        const std::vector<DeviceSample> sut = readings_with({{DeviceFaultKind::stuck, begin, 5}});
        const std::size_t last = std::max<std::uint64_t>(begin, 1) - 1;
        for (std::size_t i = begin; i < begin + 5; ++i)
        {
            EXPECT_TRUE(sut[i].valid);
            EXPECT_EQ(sut[i].position_world_m, sut[last].position_world_m);
            EXPECT_EQ((*sut[i].velocity_world_m_per_s)[0], 0.0);
            EXPECT_EQ(sut[i].time.ns, static_cast<std::int64_t>(i) * 1'000'000);
        }
        const double way_m = sut[begin + 5].position_world_m[0] - sut[last].position_world_m[0];
        EXPECT_GT(way_m, 0.0);
        EXPECT_NEAR((*sut[begin + 5].velocity_world_m_per_s)[0], way_m / 1e-3, 1e-9);
    }
}

TEST(FaultyDevice, no_numbers_are_said_to_be_valid_and_never_repeated)
{
    const std::vector<DeviceSample> sut =
        readings_with({{DeviceFaultKind::nan, 10, 3}, {DeviceFaultKind::dropout, 12, 5}});
    for (std::size_t i = 10; i < 12; ++i)
    {
        EXPECT_TRUE(sut[i].valid);
        EXPECT_TRUE(std::isnan(sut[i].position_world_m[2]));
        EXPECT_TRUE(std::isnan((*sut[i].velocity_world_m_per_s)[0]));
    }
    EXPECT_EQ(sut[16].position_world_m, sut[9].position_world_m);
}

TEST(FaultyDevice, time_jumps_ahead_by_a_second_and_falls_back)
{
    const std::vector<DeviceSample> sut = readings_with({{DeviceFaultKind::time_jump, 10, 5}});
    EXPECT_EQ(sut[10].time.ns, 1'010'000'000);
    EXPECT_EQ(sut[14].time.ns, 1'014'000'000);
    EXPECT_EQ(sut[15].time.ns, 15'000'000);
}

TEST(FaultyDevice, disconnected_makes_no_force_and_comes_back_idle)
{
    auto device =
        std::move(SimulatedDevice::create({}, std::make_unique<test::OperatorAtRest>())).value();
    const SimulatedDevice& simulated = *device;
    FaultyDevice sut(std::move(device), {{DeviceFaultKind::disconnect, 10, 5}});
    for (std::uint64_t i = 0; i < 20; ++i)
    {
        const bool is_away = i >= 10 && i < 15;
        const DeviceSample sample = sut.read();
        EXPECT_EQ(sample.connected, !is_away);
        EXPECT_EQ(sample.valid, !is_away);
        EXPECT_EQ(sut.status().state,
                  i == 0 || is_away || i == 15 ? DeviceState::idle : DeviceState::force);
        sut.write({{1.0, 0.0, 0.0}, {}, 0.0});
        EXPECT_EQ(simulated.felt_force_world_n().x(), is_away ? 0.0 : 1.0);
    }
}

TEST(FaultyDevice, disconnected_stays_braked_when_it_was)
{
    FaultyDevice sut(walking_device(), {{DeviceFaultKind::disconnect, 10, 5}});
    sut.brake();
    static_cast<void>(readings(sut));
    EXPECT_EQ(sut.status().state, DeviceState::brake);
    sut.release_brake();
    EXPECT_EQ(sut.status().state, DeviceState::idle);
}

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
