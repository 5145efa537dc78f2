// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/allocation_counter.hpp"
#include "platform/haptic_device.hpp"
#include "platform/simulated/simulated_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

namespace tactus
{

namespace
{

class HandAtRest final : public HandMotion
{
public:
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return Vec3::Zero(); }
    [[nodiscard]] Vec3 next_world_m(const HandSense&) noexcept override { return Vec3::Zero(); }
};

std::unique_ptr<HapticDevice> make_simulated()
{
    return std::move(SimulatedDevice::create({}, std::make_unique<HandAtRest>())).value();
}

/// What every device promises, given a hand that holds it loosely at one place.
class HapticDeviceConformance : public testing::TestWithParam<std::unique_ptr<HapticDevice> (*)()>
{
protected:
    /// Displacement from the first reading after a while under a steady force.
    double drift_m(const std::array<double, 3>& force_n, int frames)
    {
        const auto start = sut->read().position_world_m;
        DeviceSample sample;
        for (int i = 0; i < frames; ++i)
        {
            sut->write(force_n);
            sample = sut->read();
        }
        const auto end = sample.position_world_m;
        return std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
    }

    std::unique_ptr<HapticDevice> sut = GetParam()();
};

INSTANTIATE_TEST_SUITE_P(Simulated, HapticDeviceConformance, testing::Values(&make_simulated));

TEST_P(HapticDeviceConformance, describes_itself_with_sane_limits)
{
    const DeviceInfo& info = sut->info();
    EXPECT_FALSE(info.name.empty());
    EXPECT_GT(info.limits.force_max_n, 0.0);
    EXPECT_GT(info.limits.stiffness_max_n_per_m, 0.0);
    EXPECT_GE(info.limits.damping_n_s_per_m, 0.0);
    EXPECT_GT(info.workspace_radius_m, 0.0);
    EXPECT_GT(info.speed_max_m_per_s, 0.0);
    EXPECT_GT(info.rate_min_hz, 0);
    EXPECT_GE(info.rate_max_hz, info.rate_min_hz);
}

TEST_P(HapticDeviceConformance, counts_its_readings_and_never_goes_back_in_time)
{
    MonotonicTime last = sut->read().time;
    for (std::uint64_t frame = 1; frame < 100; ++frame)
    {
        const DeviceSample sample = sut->read();
        EXPECT_TRUE(sample.valid);
        EXPECT_TRUE(sample.connected);
        EXPECT_TRUE(sample.deadman_held);
        EXPECT_EQ(sample.frame, frame);
        EXPECT_GT(sample.time, last);
        last = sample.time;
    }
    EXPECT_EQ(sut->status().frames, 100U);
}

TEST_P(HapticDeviceConformance, is_idle_until_the_first_force)
{
    static_cast<void>(sut->read());
    EXPECT_EQ(sut->status().state, DeviceState::idle);
    sut->write({0.0, 0.0, 0.0});
    EXPECT_EQ(sut->status().state, DeviceState::force);
}

TEST_P(HapticDeviceConformance, gives_way_to_the_force_it_is_told_to_make)
{
    EXPECT_GT(drift_m({0.0, 1.0, 0.0}, 300), 1e-3);
}

TEST_P(HapticDeviceConformance, clamps_a_force_beyond_its_limit_and_counts_it)
{
    const double limit_n = sut->info().limits.force_max_n;
    auto other = GetParam()();
    const double at_limit_m = drift_m({limit_n, 0.0, 0.0}, 300);
    sut.swap(other);
    const double beyond_m = drift_m({1e6, 0.0, 0.0}, 300);
    EXPECT_NEAR(beyond_m, at_limit_m, 1e-9);
    EXPECT_EQ(sut->status().forces_clamped, 300U);
}

TEST_P(HapticDeviceConformance, refuses_a_force_that_is_not_finite_and_makes_none)
{
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        EXPECT_EQ(drift_m({0.0, bad, 1.0}, 50), 0.0);
    }
    EXPECT_EQ(sut->status().forces_refused, 100U);
}

TEST_P(HapticDeviceConformance, ignores_forces_from_the_brake_to_its_release)
{
    sut->write({5.0, 0.0, 0.0});
    std::thread other([&] { sut->brake(); });
    other.join();
    EXPECT_EQ(sut->status().state, DeviceState::brake);
    EXPECT_EQ(drift_m({5.0, 0.0, 0.0}, 100), 0.0);
    sut->brake(); // Again, to no effect.
    EXPECT_EQ(drift_m({5.0, 0.0, 0.0}, 10), 0.0);
    sut->release_brake();
    EXPECT_EQ(sut->status().state, DeviceState::idle);
    const auto start = sut->read().position_world_m;
    EXPECT_EQ(sut->read().position_world_m, start); // Not the force from before.
    EXPECT_GT(drift_m({5.0, 0.0, 0.0}, 100), 0.0);
    EXPECT_EQ(sut->status().state, DeviceState::force);
}

TEST_P(HapticDeviceConformance, leaves_the_heap_alone)
{
    if (!allocation_counter::available())
    {
        GTEST_SKIP() << "allocation counter: not available under a sanitizer or without glibc";
    }
    const auto before = allocation_counter::of_this_thread();
    allocation_counter::mark_this_thread(true);
    for (int i = 0; i < 100; ++i)
    {
        static_cast<void>(sut->read());
        sut->write({0.1, 0.2, 0.3});
    }
    sut->brake();
    sut->release_brake();
    allocation_counter::mark_this_thread(false);
    const auto after = allocation_counter::of_this_thread();
    EXPECT_EQ(after.allocations, before.allocations);
    EXPECT_EQ(after.frees, before.frees);
}

} // namespace

} // namespace tactus
