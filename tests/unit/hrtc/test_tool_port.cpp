// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/fixture.hpp"
#include "platform/devices/device_force.hpp"
#include "platform/loop/tool_port.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace tactus::hrtc
{
namespace
{

using test::kPeriod_s;

/// Still, connected device in use; keeps the last written force.
struct StillDevice final : HapticDevice
{
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
        sample.position_world_m = to_array(hand.position_m);
        if (info_.limits.rotation.is_measured)
        {
            sample.rotation_world = rotation.value_or(to_quaternion(hand.rotation));
        }
        sample.buttons = buttons;
        return sample;
    }
    void write(const Wrench& wrench) noexcept override
    {
        written_n = to_vec3(wrench.force_world_n);
        written_gripper_n = wrench.gripper_force_n;
    }
    void brake() noexcept override {}
    void release_brake() noexcept override {}
    [[nodiscard]] DeviceStatus status() const noexcept override
    {
        return {DeviceState::force, 0, 0, 0};
    }

    void measure_rotation() { info_.limits.rotation.is_measured = true; }

    Vec3 written_n{0.0, 0.0, 0.0};
    double written_gripper_n{0.0};
    DevicePose hand;
    std::uint32_t buttons{0};
    std::optional<Quaternion> rotation; ///< Rotation in place of the hand's.

private:
    DeviceInfo info_;
    std::int64_t reads_{0};
};

/// Source of a given external force.
struct SaidForce final : ExternalForceSource
{
    [[nodiscard]] ExternalForce next(const DeviceSample& /*sample*/, const ToolState& tool,
                                     const ToolOutput& output) noexcept override
    {
        place_m = tool.position_m;
        was_in_contact = output.in_contact;
        return said;
    }

    ExternalForce said;
    Vec3 place_m{0.0, 0.0, 0.0};
    bool was_in_contact{false};
};

struct ToolPortTest : testing::Test
{
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
    const ToolForce& step(const ToolOutput& output)
    {
        static_cast<void>(sut_->read(1));
        const ToolForce& force = sut_->make_safe(output, {kPeriod_s, ForceOff::none});
        sut_->write();
        last_ = force;
        return last_;
    }
    void steps(const ToolOutput& output, int count)
    {
        for (int i = 0; i < count; ++i)
        {
            static_cast<void>(step(output));
        }
    }
    /// Creates a port from the present set-up.
    void restart() { sut_ = std::make_unique<ToolPort>(setup_); }
    /// Steps until the force is at full gain.
    void warm_up()
    {
        steps(pushed_, 200);
        ASSERT_NEAR((device().written_n - pushed_.force_n).norm(), 0.0, 1e-9);
    }
    [[nodiscard]] StillDevice& device() const { return static_cast<StillDevice&>(*setup_.device); }

    ToolSetup setup_;
    std::unique_ptr<ToolPort> sut_;
    ToolOutput pushed_;
    ToolForce last_; ///< Last force of step().
};

/// Place with a rotation about z by a unit quaternion.
DevicePose turned_place(const Vec3& position_m, double z, double w)
{
    return {position_m, to_rotation({0.0, 0.0, z, w})};
}

TEST_F(ToolPortTest, the_tool_turns_as_the_device_says)
{
    device().measure_rotation();
    device().hand = turned_place(Vec3(1.0, 2.0, 3.0), 0.6, 0.8);
    const ToolState& state = sut_->read(1);
    EXPECT_TRUE(state.valid);
    EXPECT_LT((state.rotation - device().hand.rotation).norm(), 1e-15);
    EXPECT_FALSE(sut_->record().pose);
    EXPECT_TRUE(sut_->record().measures_rotation);
}

TEST_F(ToolPortTest, a_rotation_that_is_none_makes_the_sample_invalid)
{
    device().measure_rotation();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Quaternion& bad :
         {Quaternion{}, Quaternion{0.0, 0.0, 0.0, 1.01}, Quaternion{nan, 0.0, 0.0, 1.0}})
    {
        device().rotation = bad;
        EXPECT_FALSE(sut_->read(1).valid) << bad[3];
    }
    device().rotation.reset();
    EXPECT_TRUE(sut_->read(1).valid);
}

TEST_F(ToolPortTest, a_force_of_the_programs_own_goes_out_and_fades_as_that_of_surfaces)
{
    SaidForce own;
    own.said.force_n = Vec3(1.0, 0.0, 0.0);
    own.said.gripper_n = 0.5;
    setup_.external_force = &own;
    restart();
    device().hand.position_m = Vec3(0.0, 0.0, 0.001);
    steps(pushed_, 200);
    const Vec3 both_n = pushed_.force_n + own.said.force_n;
    EXPECT_LT((device().written_n - both_n).norm(), 1e-9);
    EXPECT_EQ(device().written_gripper_n, 0.5);
    EXPECT_EQ(sut_->record().sent_gripper_n, 0.5);
    EXPECT_EQ(own.place_m, device().hand.position_m);
    EXPECT_TRUE(own.was_in_contact);

    ToolOutput stuck = pushed_;
    stuck.sample_fault = FrameFault::tool_stuck;
    own.said.gripper_n = 7.0; // Results of bad data are not sent.
    static_cast<void>(step(stuck));
    const double gain = device().written_n.norm() / both_n.norm();
    EXPECT_NEAR(gain, 1.0 - kPeriod_s / kFadeTime_s, 1e-9);
    EXPECT_NEAR(device().written_gripper_n, gain * 0.5, 1e-9);
    steps(stuck, 60);
    EXPECT_EQ(device().written_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(device().written_gripper_n, 0.0);
}

TEST_F(ToolPortTest, a_force_of_the_programs_own_that_is_no_number_is_garbage)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int part = 0; part < 4; ++part)
    {
        SaidForce own;
        setup_.external_force = &own;
        restart();
        warm_up();
        own.said.force_n.x() = part == 0 ? nan : 0.0;
        own.said.stiffness_n_per_m = part == 1 ? nan : 0.0;
        own.said.force_n.y() = part == 1 ? 1.0 : 0.0;
        own.said.gripper_n = part == 2 ? nan : 0.0;
        own.said.gripper_n = part == 3 ? 1.0 / 0.0 : own.said.gripper_n;
        EXPECT_EQ(step(pushed_).causes, ForceOff::garbage) << part;
        EXPECT_TRUE(device().written_n.allFinite() && std::isfinite(device().written_gripper_n));
        EXPECT_GT(device().written_n.norm(), 0.0) << "the last one fades";
    }
}

TEST_F(ToolPortTest, a_held_button_parts_hand_and_tool_without_a_force)
{
    device().measure_rotation();
    setup_.clutch_button = 3;
    restart();
    warm_up();
    device().buttons = 4; // Another button.
    EXPECT_EQ(step(pushed_).causes, ForceOff::none);
    const ToolState held = sut_->read(1);

    device().buttons = 8;
    for (int i = 1; i <= 60; ++i)
    {
        device().hand = turned_place(Vec3(0.0005 * i, 0.0, 0.0), 0.6, 0.8);
        EXPECT_EQ(step(pushed_).causes, ForceOff::clutch);
        EXPECT_EQ(sut_->read(1).position_m, held.position_m);
        EXPECT_EQ(sut_->read(1).rotation, held.rotation);
    }
    EXPECT_EQ(device().written_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(sut_->record().pose->position_m, device().hand.position_m);

    device().buttons = 0;
    EXPECT_LT((sut_->read(1).position_m - held.position_m).norm(), 1e-15) << "goes on from there";
    EXPECT_LT((sut_->read(1).rotation - held.rotation).norm(), 1e-15);
    EXPECT_EQ(step(pushed_).causes, ForceOff::none);
    // Return to the hand's start: the tool rotates equally about the world's axes.
    const Mat3 way = to_rotation({0.0, 0.0, -0.6, 0.8});
    device().hand = DevicePose{};
    EXPECT_LT((sut_->read(1).rotation - way * held.rotation).norm(), 1e-14);
    EXPECT_LT((sut_->read(1).position_m - held.position_m - Vec3(-0.03, 0.0, 0.0)).norm(), 1e-14);
}

/// The surface force is the same to the last bit, with the passivity observer.
TEST_F(ToolPortTest, a_load_is_carried_beside_the_force_and_while_the_proxy_is_frozen)
{
    setup_.load.mass_kg = 0.2;
    ToolSetup bare;
    bare.device = std::make_unique<StillDevice>();
    bare.limits = setup_.limits;
    bare.conditioner = setup_.conditioner;
    restart();
    ToolPort without(bare);
    for (int i = 0; i < 400; ++i)
    {
        pushed_.stiffness_n_per_m = 500.0;
        pushed_.halted = i > 300;
        device().hand.position_m = Vec3(0.0, 0.0, 1e-3 * std::sin(0.1 * i));
        static_cast<StillDevice&>(*bare.device).hand = device().hand;
        static_cast<void>(step(pushed_));
        static_cast<void>(without.read(1));
        const ToolForce& bare_force = without.make_safe(pushed_, {kPeriod_s, ForceOff::none});
        ASSERT_EQ(last_.push.force_n, bare_force.push.force_n) << i;
        ASSERT_EQ(last_.push.work_j, bare_force.push.work_j) << i;
    }
    EXPECT_EQ(last_.push.force_n, Vec3(0.0, 0.0, 0.0)) << "halted";
    EXPECT_NEAR(device().written_n.z(), setup_.load.weight_n(), 1e-12);
    sut_->fade(0.025, ForceOff::assertion);
    EXPECT_NEAR(device().written_n.z(), 0.5 * setup_.load.weight_n(), 1e-12);
    sut_->fade(0.025, ForceOff::assertion);
    EXPECT_EQ(device().written_n, Vec3(0.0, 0.0, 0.0));
}

TEST_F(ToolPortTest, a_sample_that_is_not_to_be_trusted_doesnt_move_the_clutch)
{
    setup_.clutch_button = 0;
    restart();
    device().buttons = 1;
    static_cast<void>(sut_->read(1));
    device().buttons = 0;
    device().hand.position_m.x() = std::numeric_limits<double>::quiet_NaN();
    static_cast<void>(sut_->read(1));
    device().hand.position_m = Vec3(5.0, 0.0, 0.0);
    EXPECT_EQ(sut_->read(1).position_m, Vec3(0.0, 0.0, 0.0)) << "it was let go only now";
}

using tactus::test::Random;

VirtualFixture fixture_of(const std::string& words)
{
    const auto choice = parse_fixture(words);
    EXPECT_TRUE(choice) << words;
    return VirtualFixture(choice ? choice.value() : FixtureChoice{});
}

ExternalForce force_at(VirtualFixture& fixture, const Vec3& place_m, bool valid = true)
{
    ToolState tool;
    tool.position_m = place_m;
    tool.valid = valid;
    return fixture.next({}, tool, {});
}

} // namespace

TEST(VirtualFixture, pulls_to_a_point_a_line_and_to_the_front_of_a_plane)
{
    VirtualFixture point = fixture_of("point:0.1,0,0,200,5");
    EXPECT_LT((force_at(point, Vec3(0.11, 0.0, 0.0)).force_n - Vec3(-2.0, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_EQ(force_at(point, Vec3(0.11, 0.0, 0.0)).stiffness_n_per_m, 200.0);
    VirtualFixture line = fixture_of("line:0,0,0.1,0,0,-3,200,5");
    EXPECT_LT((force_at(line, Vec3(0.0, 0.01, 7.0)).force_n - Vec3(0.0, -2.0, 0.0)).norm(), 1e-12);
    VirtualFixture plane = fixture_of("plane:0,0,0.1,0,0,2,200,5");
    EXPECT_EQ(force_at(plane, Vec3(3.0, 2.0, 0.1)).force_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(force_at(plane, Vec3(3.0, 2.0, 0.2)).force_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_LT((force_at(plane, Vec3(3.0, 2.0, 0.09)).force_n - Vec3(0.0, 0.0, 2.0)).norm(), 1e-12);
    VirtualFixture soft = fixture_of("point:0,0,0"); // 100 N/m, at most 1 N.
    EXPECT_NEAR(force_at(soft, Vec3(0.0, 0.005, 0.0)).force_n.y(), -0.5, 1e-12);
    EXPECT_NEAR(force_at(soft, Vec3(0.0, 0.0, -9.0)).force_n.z(), 1.0, 1e-12);
}

TEST(VirtualFixture, holds_a_gripper_so_far_open_and_leaves_the_hand_free)
{
    VirtualFixture fixture = fixture_of("gripper:0.02,200,3");
    ToolState tool;
    tool.valid = true;
    DeviceSample sample;
    sample.valid = true;
    const auto grip_n = [&](std::optional<double> open_m)
    {
        sample.gripper_m = open_m;
        const ExternalForce own = fixture.next(sample, tool, {});
        EXPECT_EQ(own.force_n, Vec3(0.0, 0.0, 0.0));
        return own.gripper_n;
    };
    EXPECT_EQ(grip_n({}), 0.0); // No command so far.
    EXPECT_NEAR(grip_n(0.03), -2.0, 1e-12);
    EXPECT_NEAR(grip_n(0.01), 2.0, 1e-12);
    EXPECT_EQ(grip_n(0.5), -3.0);
    EXPECT_EQ(grip_n({}), -3.0);
    EXPECT_EQ(grip_n(std::numeric_limits<double>::quiet_NaN()), -3.0);
    sample.valid = false;
    EXPECT_EQ(grip_n(0.02), -3.0);
}

TEST(VirtualFixture, makes_no_energy_on_any_way_that_closes)
{
    Random random(2'511);
    for (const std::string words :
         {"point:0.01,0,0,300,2", "line:0,0,0,1,2,3,300,2", "plane:0,0,0,1,-1,0.5,300,2"})
    {
        VirtualFixture fixture = fixture_of(words);
        for (int round = 0; round < 20; ++round)
        {
            // Closed path of three harmonics about all axes, for which trapezoids are exact except
            // where the spring saturates or releases.
            Mat3 swing;
            for (int i = 0; i < 9; ++i)
            {
                swing(i / 3, i % 3) = random.between(-0.02, 0.02);
            }
            const auto at = [&](double turn)
            { return Vec3(swing * Vec3(std::sin(turn), std::cos(2 * turn), std::sin(3 * turn))); };
            constexpr int kSteps = 20'000;
            double work_j = 0.0;
            double exchanged_j = 0.0;
            for (int i = 0; i < kSteps; ++i)
            {
                const Vec3 from_m = at(2.0 * M_PI * i / kSteps);
                const Vec3 to_m = at(2.0 * M_PI * (i + 1) / kSteps);
                const Vec3 mean_n =
                    0.5 * (force_at(fixture, from_m).force_n + force_at(fixture, to_m).force_n);
                work_j += mean_n.dot(to_m - from_m);
                exchanged_j += std::abs(mean_n.dot(to_m - from_m));
            }
            EXPECT_LT(std::abs(work_j), 1e-5 * exchanged_j + 1e-12) << words << ", " << round;
        }
    }
}

TEST(VirtualFixture, stays_as_it_was_while_the_device_says_no_place)
{
    VirtualFixture fixture = fixture_of("point:0,0,0");
    const Vec3 before_n = force_at(fixture, Vec3(0.005, 0.0, 0.0)).force_n;
    EXPECT_EQ(force_at(fixture, Vec3(0.002, 0.0, 0.0), false).force_n, before_n);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(force_at(fixture, Vec3(nan, 0.0, 0.0)).force_n, before_n);
    EXPECT_EQ(force_at(fixture, Vec3(0.0, 0.0, 0.0)).force_n, Vec3(0.0, 0.0, 0.0));
    const Vec3 far_n = force_at(fixture, Vec3(1e300, 1e300, 0.0)).force_n;
    EXPECT_TRUE(far_n.allFinite());
    EXPECT_LE(far_n.norm(), 1.0 + 1e-12);
}

TEST(VirtualFixture, takes_a_direction_of_any_length)
{
    EXPECT_FALSE(parse_fixture("none")); // The option's own word, not a fixture.
    const auto thin = parse_fixture("line:0,0,0,1e-300,0,0");
    ASSERT_TRUE(thin);
    EXPECT_LT((thin.value().direction - Vec3(1.0, 0.0, 0.0)).norm(), 1e-15);
}
} // namespace tactus::hrtc
