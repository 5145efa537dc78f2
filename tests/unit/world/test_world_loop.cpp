// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/world/world_rig.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>

/// Worlds with the guarded loop. Waits are for events; no test compares times.
namespace tactus::test
{
namespace
{

using namespace std::chrono_literals;

/// Options of a loop that runs on any machine.
WorldOptions anywhere()
{
    return {.allow_no_rt = true};
}

/// Waits for an event; a failure names it.
void wait_for(const char* event, const std::function<bool()>& has_come)
{
    for (int i = 0; i < 6'000 && !has_come(); ++i)
    {
        std::this_thread::sleep_for(5ms);
    }
    ASSERT_TRUE(has_come()) << event << " has not come";
}

TEST(WorldLoop, a_simulated_operator_touches_and_other_threads_look_on)
{
    World world(anywhere());
    const WorldObject part = world.add(cube());
    const Hand hand = world.add(sphere(kRadius_m), device("sim"));
    ASSERT_TRUE(hand) << hand.error();
    const auto started = world.start();
    ASSERT_TRUE(started) << started.error().text;
    EXPECT_TRUE(world.is_running());
    EXPECT_EQ(line_of(world.start()), "start(): the loop runs already");
    EXPECT_NE(line_of(world.step()).find("the loop of start() runs"), std::string::npos);
    EXPECT_NE(line_of(hand.hold({})).find("a device moves this hand"), std::string::npos);
    wait_for("a touch", [&] { return hand.state().in_contact; });
    EXPECT_TRUE(part.feel({.stiffness_n_per_m = 300.0}));
    EXPECT_TRUE(part.move({.translation_m = {0.001, 0.0, 0.0}}));
    wait_for("more frames",
             [&, frames = world.counts().frames] { return world.counts().frames > frames + 50; });
    const auto stopped = world.stop();
    EXPECT_TRUE(stopped) << line_of(stopped);
    EXPECT_FALSE(world.is_running());
    EXPECT_EQ(hand.state().withheld, Withheld::ended);
    EXPECT_EQ(line_of(world.start()), "start(): the World has ended; make a new one");
}

TEST(WorldLoop, a_hand_of_the_program_is_moved_from_outside)
{
    World world(anywhere());
    static_cast<void>(world.add(cube()));
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(hand.hold(above(0.01)));
    ASSERT_TRUE(world.start());
    wait_for("the hand",
             [&]
             {
                 EXPECT_TRUE(hand.hold(above(0.01)));
                 return hand.state().position_m[2] > 0.0;
             });
    // A pose that is not renewed is stuck.
    wait_for("a stuck hand", [&] { return hand.state().withheld == Withheld::stale; });
    EXPECT_TRUE(world.stop());
}

TEST(WorldLoop, callbacks_that_throw_or_block_are_counted_and_may_not_call_the_world)
{
    World world(anywhere());
    const WorldObject part = world.add(cube());
    std::atomic<int> calls{0};
    std::atomic<int> refused{0};
    Hand hand;
    const HandForce force = [&](const ToolState&, const ToolOutput&) -> ExternalForce
    {
        const int call = calls.fetch_add(1);
        if (call == 10)
        {
            refused += part.move({}) ? 0 : 1;
            refused += world.stop() ? 0 : 1;
            refused += hand.hold({}) ? 0 : 1;
            refused += world.add(part) ? 0 : 1;
        }
        if (call == 20)
        {
            std::this_thread::sleep_for(3ms);
        }
        if (call == 30)
        {
            throw std::runtime_error("no force");
        }
        return {};
    };
    hand = world.add(sphere(kRadius_m), device("sim"), {.force = force});
    const auto started = world.start();
    ASSERT_TRUE(started) << line_of(started);
    wait_for("a throw", [&] { return world.counts().callback_throws == 1; });
    EXPECT_GE(world.counts().callback_overruns, 1U);
    EXPECT_EQ(refused.load(), 4);
    wait_for("more frames",
             [&, frames = world.counts().frames] { return world.counts().frames > frames + 20; });
    EXPECT_TRUE(world.stop());
}

TEST(WorldLoop, a_device_of_ones_own_that_disappears_ends_the_force_not_the_loop)
{
    /// Still hand, which disconnects when it is told to.
    class OwnDevice final : public HapticDevice
    {
    public:
        explicit OwnDevice(double mass_kg = 0.1)
        {
            info_.limits.mass_kg = mass_kg;
            info_.name = "own";
            info_.workspace_radius_m = 1.0;
            info_.speed_max_m_per_s = 1.0;
            info_.rate_min_hz = 100;
            info_.rate_max_hz = 10'000;
        }
        [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
        [[nodiscard]] DeviceSample read() noexcept override
        {
            sample_.position_world_m = {0.0, 0.0, 0.1};
            sample_.frame++;
            sample_.valid = !is_gone;
            sample_.connected = !is_gone;
            return sample_;
        }
        void write(const Wrench& /*wrench*/) noexcept override {}
        void brake() noexcept override {}
        void release_brake() noexcept override {}
        [[nodiscard]] DeviceStatus status() const noexcept override { return {}; }

        std::atomic<bool> is_gone{false};

    private:
        DeviceInfo info_;
        DeviceSample sample_;
    };
    World world(anywhere());
    static_cast<void>(world.add(cube()));
    EXPECT_EQ(World().add(sphere(kRadius_m), device(std::make_shared<OwnDevice>(0.0))).error(),
              "device: mass_kg must be finite and > 0");
    const auto own = std::make_shared<OwnDevice>();
    const Hand hand = world.add(sphere(kRadius_m), device(own));
    const auto owners = own.use_count();
    const auto started = world.start();
    ASSERT_TRUE(started) << line_of(started);
    wait_for("a frame", [&] { return hand.state().withheld == Withheld::nothing; });
    own->is_gone = true;
    wait_for("the loss", [&] { return hand.state().withheld == Withheld::disconnect; });
    EXPECT_NE(hand.why(hand.state()).find("the device disconnected"), std::string::npos);
    own->is_gone = false;
    wait_for("the return", [&] { return hand.state().withheld == Withheld::nothing; });
    EXPECT_GT(own.use_count(), owners);
    EXPECT_TRUE(world.stop());
    EXPECT_EQ(own.use_count(), owners) << "an ended loop keeps no device";
}

TEST(WorldLoop, one_loop_runs_in_a_process_and_a_refused_start_may_be_tried_again)
{
    World first(anywhere());
    static_cast<void>(first.add(cube()));
    static_cast<void>(first.add(sphere(kRadius_m), device("sim")));
    World second(anywhere());
    static_cast<void>(second.add(cube()));
    const Hand hand = second.add(sphere(kRadius_m), device("sim"));
    ASSERT_TRUE(first.start());
    EXPECT_EQ(line_of(second.start()),
              "start(): another World of this process runs its loop; stop it first");
    EXPECT_EQ(hand.state().withheld, Withheld::no_frame);
    EXPECT_TRUE(first.stop());
    const auto started = second.start();
    EXPECT_TRUE(started) << line_of(started);
    EXPECT_TRUE(second.stop());
}

TEST(WorldLoop, a_loop_of_a_given_duration_ends_by_itself)
{
    World world({.duration_s = 0.2, .allow_no_rt = true});
    static_cast<void>(world.add(cube()));
    static_cast<void>(world.add(sphere(kRadius_m), device("sim")));
    ASSERT_TRUE(world.start());
    const auto ended = world.wait();
    EXPECT_TRUE(ended) << line_of(ended);
    EXPECT_GT(world.counts().frames, 0U);
    EXPECT_FALSE(world.is_running());
}

} // namespace
} // namespace tactus::test
