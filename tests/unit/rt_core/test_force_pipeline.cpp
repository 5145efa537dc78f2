// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/device_classes.hpp"
#include "rt_core/force/force_pipeline.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

namespace tactus::test
{

namespace
{

constexpr double kOperatorSpeed_m_per_s = 0.8;
constexpr double kObjectSpeed_m_per_s = 0.5;

/// Sphere, or a box of 1 cm, on this device.
PipelineSetup piped(const DeviceLimits& device, bool is_box = false)
{
    ToolSpec tool;
    tool.radius_m = 0.002;
    if (is_box)
    {
        tool.core = Box{Vec3(0.005, 0.005, 0.005)};
    }
    PipelineSetup setup = pipeline_setup(tool, device, kPeriod_s, kOperatorSpeed_m_per_s);
    setup.change.object_speed_max_m_per_s = kObjectSpeed_m_per_s;
    return setup;
}

/// One tool, period by period.
class PipedTool
{
public:
    explicit PipedTool(const PipelineSetup& setup) : sut(setup)
    {
        output.in_contact = true;
        output.stiffness_n_per_m = 500.0;
    }

    const ToolForce& step()
    {
        state.sample_time_ns += 1'000'000;
        context.elapsed_s = kPeriod_s * state.elapsed_periods;
        return sut.step(state, output, device, own, context);
    }
    void steps(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            static_cast<void>(step());
        }
    }
    /// Places the surface at height 0 and the hand below it.
    void press(double depth_m)
    {
        state.position_m = Vec3(0.0, 0.0, -depth_m);
        output.proxy_m = Vec3(0.0, 0.0, 0.0);
        output.force_n = Vec3(0.0, 0.0, output.stiffness_n_per_m * depth_m);
    }
    [[nodiscard]] const Vec3& sent_n() const { return sut.force().push.force_n; }

    ForcePipeline sut;
    ToolState state;
    ToolOutput output;
    DeviceRecord device;
    ExternalForce own;
    PeriodContext context;
};

/// Least distance from `now` to a point between `from` and `to`, by trial.
double beside(const Vec3& from, const Vec3& to, const Vec3& now)
{
    double low = 0.0;
    double high = 1.0;
    const auto off = [&](double share) { return (now - (1.0 - share) * from - share * to).norm(); };
    for (int i = 0; i < 100; ++i)
    {
        const double third = (high - low) / 3.0;
        if (off(low + third) < off(high - third))
        {
            high -= third;
        }
        else
        {
            low += third;
        }
    }
    return off(0.5 * (low + high));
}

/// Tool with random events of all kinds: of the frame, the program, the device, the loop and moving
/// objects.
class WildTool
{
public:
    WildTool(const DeviceLimits& device, bool is_box, double slew, Random& random)
        : device_(device), is_box_(is_box), slew_(slew), random_(random), tool_(setup())
    {
    }

    /// Next period, in which the law must hold.
    void step(std::uint32_t frame)
    {
        const Vec3 last_n = tool_.sut.force().push.force_n;
        const Vec3 last_nm = tool_.sut.force().torque.force_n;
        const ExternalForce last_own = tool_.own;
        happen();
        const ToolForce& now = tool_.step();
        const double way_m =
            std::min({hand_way_.norm(), (hand_way_ - tool_.output.carried_m).norm(),
                      kOperatorSpeed_m_per_s * kPeriod_s});
        const double arm_m = is_box_ ? arm() : 0.0;
        const double moved_m =
            std::min(tool_.output.object_way_m + arm_m * tool_.output.object_rotation_rad,
                     kObjectSpeed_m_per_s * kPeriod_s);
        const double stiffness = tool_.output.stiffness_n_per_m + tool_.own.stiffness_n_per_m;
        const double most_n = stiffness * (way_m + arm_m * hand_rotation_rad_ + moved_m) +
                              slew_ * device_.force_max_n + kRounding;
        const double angular =
            arm_m * arm_m * tool_.output.stiffness_n_per_m + tool_.own.stiffness_nm_per_rad;
        const double most_nm = angular * hand_rotation_rad_ +
                               stiffness * arm_m * (way_m + moved_m) +
                               slew_ * device_.rotation.torque_max_nm + kRounding;
        check(frame, "force", now.push.force_n, last_n, last_own.force_n, most_n, now.causes);
        check(frame, "torque", now.torque.force_n, last_nm, last_own.torque_nm, most_nm,
              now.causes);
        EXPECT_LE(now.push.force_n.norm(), device_.force_max_n * (1.0 + kRounding)) << frame;
        EXPECT_LE(now.torque.force_n.norm(), device_.rotation.torque_max_nm * (1.0 + kRounding))
            << frame;
        const bool is_held =
            has_action(now.push.actions | now.torque.actions, ForceAction::change_limited);
        held += is_held ? 1U : 0U;
        felt += now.push.force_n.norm() > 0.1 ? 1U : 0U;
        run_ = is_held ? run_ + tool_.state.elapsed_periods : 0;
        EXPECT_EQ(has_cause(now.causes, ForceOff::growth), run_ > 20) << frame;
        told += has_cause(now.causes, ForceOff::growth) ? 1U : 0U;
    }

    std::uint32_t held{0};
    std::uint32_t told{0};
    std::uint32_t felt{0};

private:
    static constexpr double kRounding = 1e-9;

    [[nodiscard]] PipelineSetup setup() const
    {
        PipelineSetup setup = piped(device_, is_box_);
        setup.change.slew_share_per_ms = slew_;
        return setup;
    }
    [[nodiscard]] static double arm() { return Vec3(0.005, 0.005, 0.005).norm() + 0.002; }

    void check(std::uint32_t frame, const char* what, const Vec3& now, const Vec3& last,
               const Vec3& own, double most, ForceOff causes) const
    {
        const Vec3 zero(0.0, 0.0, 0.0);
        const bool fades = (causes | ForceOff::growth) != ForceOff::growth;
        const bool is_left = !tool_.output.in_contact;
        const double off = fades     ? beside(last, zero, now)
                           : is_left ? std::min(beside(last, zero, now), beside(last, own, now))
                                     : (now - last).norm();
        ASSERT_LE(off, most) << what << " in frame " << frame << ", seed " << Random::seed();
    }

    void happen()
    {
        if (random_.one_in(40))
        {
            touch();
        }
        move_hand();
        tool_.output.force_n += random_.in_cube(random_.one_in(20) ? 4.0 : 0.02);
        tool_.output.torque_nm += random_.in_cube(random_.one_in(20) ? 0.2 : 0.001);
        tool_.output.object_way_m =
            random_.one_in(10) ? random_.between(0.0, 0.03) : random_.between(0.0, 1e-4);
        tool_.output.object_rotation_rad = random_.one_in(10) ? random_.between(0.0, 0.1) : 0.0;
        tool_.output.carried_m = random_.in_cube(2e-4);
        tool_.output.halted = random_.one_in(800);
        if (random_.one_in(50))
        {
            tool_.own.force_n = random_.one_in(2) ? random_.in_cube(3.0) : Vec3(0.0, 0.0, 0.0);
            tool_.own.torque_nm = random_.in_cube(0.1);
            tool_.own.stiffness_n_per_m = random_.one_in(2) ? 200.0 : 0.0;
            tool_.own.stiffness_nm_per_rad = random_.one_in(2) ? 0.2 : 0.0;
        }
        if (random_.one_in(80))
        {
            tool_.context.surface_damping_n_s_per_m = random_.one_in(2) ? 0.0 : 20.0;
        }
        spoil();
    }
    void touch()
    {
        tool_.output.in_contact = !random_.one_in(4);
        const double stiffness = random_.between(50.0, 3'000.0);
        tool_.output.stiffness_n_per_m = tool_.output.in_contact ? stiffness : 0.0;
        const double most_n = tool_.output.in_contact ? 6.0 : 0.0;
        tool_.output.force_n = random_.in_cube(most_n);
        tool_.output.torque_nm = random_.in_cube(0.05 * most_n);
    }
    void move_hand()
    {
        const Vec3 before_m = tool_.state.position_m;
        tool_.state.position_m += random_.in_cube(random_.one_in(30) ? 5e-3 : 2e-4);
        hand_way_ = tool_.state.position_m - before_m;
        const Vec3 turn = is_box_ ? random_.in_cube(0.01) : Vec3(0.0, 0.0, 0.0);
        hand_rotation_rad_ = turn.norm();
        tool_.state.rotation = orthonormalised(turned_by(turn, tool_.state.rotation));
        tool_.output.proxy_m = tool_.state.position_m + random_.in_cube(0.002);
    }
    /// Sets causes of the loop, of the device and of invalid numbers in the frame.
    void spoil()
    {
        constexpr std::array kCauses{ForceOff::stale, ForceOff::server, ForceOff::jump,
                                     ForceOff::starved};
        const bool begins = random_.one_in(1'000);
        tool_.context.causes = begins               ? kCauses[random_.below(kCauses.size())]
                               : random_.one_in(10) ? ForceOff::none
                                                    : tool_.context.causes;
        tool_.state.elapsed_periods = random_.one_in(1'500) ? 1 + random_.below(5U) : 1;
        tool_.device.deadman_held = !random_.one_in(2'000);
        tool_.context.force_left = random_.one_in(2'500) ? random_.between(0.0, 1.0) : 1.0;
        const double nan = std::numeric_limits<double>::quiet_NaN();
        if (random_.one_in(2'000))
        {
            tool_.output.force_n.x() = nan;
        }
        else if (!tool_.output.force_n.allFinite())
        {
            tool_.output.force_n.setZero();
        }
    }

    DeviceLimits device_;
    bool is_box_;
    double slew_;
    Random& random_;
    PipedTool tool_;
    Vec3 hand_way_{0.0, 0.0, 0.0};
    double hand_rotation_rad_{0.0};
    std::uint32_t run_{0};
};

TEST(ForcePipeline, gives_no_force_to_a_hand_whose_rotation_is_none)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::array<Mat3, 4> none{Mat3(Mat3::Zero()), Mat3(Mat3::Constant(nan)),
                                   Mat3(2.0 * Mat3::Identity()), Mat3(-Mat3::Identity())};
    for (const Mat3& rotation : none)
    {
        for (const bool is_box : {false, true})
        {
            for (const bool is_held : {false, true}) // The device's own flag, besides the tool's.
            {
                PipedTool tool(piped(kOmegaClass, is_box));
                tool.press(0.004);
                tool.steps(300);
                ASSERT_GT(tool.sent_n().norm(), 1.0);
                tool.state.rotation = rotation;
                if (is_held)
                {
                    tool.device.pose = DevicePose{tool.state.position_m, rotation};
                }
                const double before_n = tool.sent_n().norm();
                EXPECT_TRUE(has_cause(tool.step().causes, ForceOff::garbage));
                EXPECT_LE(tool.sent_n().norm(), before_n);
                tool.steps(60);
                EXPECT_EQ(tool.sent_n().norm(), 0.0);
                tool.state.rotation = Mat3::Identity();
                tool.device.pose.reset();
                tool.steps(300);
                EXPECT_GT(tool.sent_n().norm(), 1.0);
            }
        }
    }
}

} // namespace

TEST(ForcePipeline, holds_the_law_on_change_in_every_pair_of_periods_whatever_happens)
{
    Random random(42);
    const std::array<std::pair<DeviceLimits, bool>, 4> devices{
        {{kTouchClass, false}, {kOmegaClass, false}, {kDeskClass, true}, {kDeskClass, false}}};
    for (const auto& [device, is_box] : devices)
    {
        for (const double slew : {kSlewShare_per_ms, 1e-3, 0.2})
        {
            WildTool tool(device, is_box, slew, random);
            for (std::uint32_t frame = 0; frame < 10'000 && !HasFatalFailure(); ++frame)
            {
                tool.step(frame);
            }
            EXPECT_GT(tool.felt, 500U);
            EXPECT_GT(tool.held, 30U);
            EXPECT_EQ(tool.told > 0, slew < 0.1) << tool.told;
        }
    }
}

/// Touch of a wall within the device's limits.
TEST(ForcePipeline, lets_an_honest_touch_through_as_it_is)
{
    for (const auto& [device, stiffness, speed] :
         {std::tuple(kOmegaClass, 1'000.0, 0.1), std::tuple(kOmegaClass, 3'000.0, 0.5),
          std::tuple(kTouchClass, 400.0, 0.3)})
    {
        PipedTool tool(piped(device));
        tool.output.in_contact = false;
        tool.steps(200); // Steps until the gain is one.
        tool.output.stiffness_n_per_m = stiffness;
        const double way_m = speed * kPeriod_s;
        const auto depth_m = [way_m](int i) { return way_m * std::min(i, 60 - i); };
        const double deepest = device.force_max_n / stiffness;
        for (int i = 1; i < 60; ++i)
        {
            tool.output.in_contact = true;
            tool.press(std::min(depth_m(i), deepest));
            const ToolForce& force = tool.step();
            ASSERT_FALSE(has_action(force.push.actions, ForceAction::change_limited)) << i;
            ASSERT_EQ(force.causes, ForceOff::none) << i;
            // The passivity controller damps the energy of the entry's period.
            ASSERT_LE((force.push.force_n - tool.output.force_n).norm(),
                      force.push.damping_n_s_per_m * speed + 1e-9)
                << i;
        }
        tool.output.in_contact = false;
        tool.press(-1e-4);
        tool.output.force_n.setZero();
        EXPECT_EQ(tool.step().push.force_n, Vec3(0.0, 0.0, 0.0)) << "left at once";
    }
}

TEST(ForcePipeline, a_force_that_the_last_stage_holds_back_fades_from_what_went_out)
{
    for (const bool has_frame : {true, false})
    {
        PipedTool tool(piped(kOmegaClass));
        tool.output.in_contact = false;
        tool.steps(200);
        tool.output.in_contact = true;
        tool.press(0.016);
        tool.steps(10);
        const Vec3 before_n = tool.sent_n();
        ASSERT_LT(before_n.norm(), 2.0);
        tool.context.causes = ForceOff::stale;
        for (int i = 1; i <= 60; ++i)
        {
            const ToolForce& force =
                has_frame ? tool.step() : tool.sut.fade(kPeriod_s, ForceOff::assertion);
            const double gain = std::max(0.0, 1.0 - i * kPeriod_s / kFadeTime_s);
            EXPECT_LT((force.push.force_n - gain * before_n).norm(), 1e-9) << i;
        }
    }
}

TEST(ForcePipeline, tells_each_change_of_state_and_causes_once)
{
    PipedTool tool(piped(kOmegaClass));
    EXPECT_TRUE(tool.step().has_changed);
    EXPECT_FALSE(tool.step().has_changed);
    tool.context.causes = ForceOff::server;
    EXPECT_TRUE(tool.step().has_changed);
    EXPECT_FALSE(tool.step().has_changed);
    tool.context.causes = ForceOff::server | ForceOff::stale;
    EXPECT_TRUE(tool.step().has_changed);
}

TEST(ForcePipeline, beside_a_load_the_force_is_within_the_device_and_holds_the_law)
{
    PipelineSetup setup = piped(kOmegaClass);
    setup.load.mass_kg = 0.5;
    PipedTool tool(setup);
    const double weight_n = setup.load.weight_n();
    Vec3 last_n(0.0, 0.0, 0.0);
    for (int i = 0; i < 1'000; ++i)
    {
        tool.press(i % 200 < 100 ? 0.02 : 0.002);
        const ToolForce& force = tool.step();
        EXPECT_LE((force.push.force_n + force.load_n).norm(), 12.0 + 1e-9) << i;
        const double moved_m = i % 100 == 0 ? kOperatorSpeed_m_per_s * kPeriod_s : 0.0;
        // While the payload force rises, the rest falls with its ramp.
        const double load_n = weight_n * kPeriod_s / kRiseTime_s;
        EXPECT_LE((force.push.force_n - last_n).norm(), 500.0 * moved_m + 0.12 + load_n + 1e-9)
            << i;
        last_n = force.push.force_n;
    }
    EXPECT_NEAR(tool.sut.force().load_n.z(), weight_n, 1e-9);
}

} // namespace tactus::test
