// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/tool_port.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace tactus::hrtc
{

namespace
{

using test::kPeriod_s;

/// Still, connected and held; keeps the last force that was written.
class StillDevice final : public HapticDevice
{
public:
    StillDevice()
    {
        info_.limits.force_max_n = 8.0;
        info_.limits.slew_max_n_per_s = 16'000.0;
        info_.limits.stiffness_max_n_per_m = 2'000.0;
    }
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        DeviceSample sample;
        sample.time.ns = ++reads_ * 1'000'000;
        sample.valid = true;
        return sample;
    }
    void write(const std::array<double, 3>& force_world_n) noexcept override
    {
        written_n = Vec3(force_world_n[0], force_world_n[1], force_world_n[2]);
    }
    void brake() noexcept override {}
    void release_brake() noexcept override {}
    [[nodiscard]] DeviceStatus status() const noexcept override
    {
        return {DeviceState::force, 0, 0, 0};
    }

    Vec3 written_n{0.0, 0.0, 0.0};

private:
    DeviceInfo info_;
    std::int64_t reads_{0};
};

class ToolPortTest : public testing::Test
{
protected:
    ToolPortTest()
    {
        setup_.device = std::make_unique<StillDevice>();
        setup_.limits = {1.0, 8.0, 500.0};
        setup_.conditioner.device = setup_.device->info().limits;
        sut_ = std::make_unique<ToolPort>(setup_);
        pushed_.force_n = Vec3(0.0, 0.0, 2.0);
        pushed_.proxy_m = Vec3(0.0, 0.0, 0.004);
        pushed_.in_contact = true;
    }
    SafetyOutput step(const ToolOutput& output)
    {
        static_cast<void>(sut_->read(1));
        const SafetyOutput safe = sut_->make_safe(output, {kPeriod_s, ForceOff::none});
        sut_->write();
        return safe;
    }
    /// Until the whole force goes out.
    void warm_up()
    {
        for (int i = 0; i < 200; ++i)
        {
            static_cast<void>(step(pushed_));
        }
        ASSERT_NEAR((device().written_n - pushed_.force_n).norm(), 0.0, 1e-9);
    }
    [[nodiscard]] const StillDevice& device() const
    {
        return static_cast<const StillDevice&>(*setup_.device);
    }

    ToolSetup setup_;
    std::unique_ptr<ToolPort> sut_;
    ToolOutput pushed_;
};

TEST_F(ToolPortTest, what_the_frame_says_of_the_tool_becomes_a_cause)
{
    warm_up();
    ToolOutput frozen = pushed_;
    frozen.frozen = true;
    EXPECT_EQ(step(frozen).causes, ForceOff::frozen);
    ToolOutput stuck = pushed_;
    stuck.sample_fault = FrameFault::tool_stuck;
    EXPECT_EQ(step(stuck).causes, ForceOff::stale);
    ToolOutput bad = pushed_;
    bad.force_n.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(step(bad).causes, ForceOff::garbage);
    EXPECT_LT(device().written_n.norm(), pushed_.force_n.norm());
}

} // namespace

} // namespace tactus::hrtc
