// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "platform/devices/simulated/scripted_operator.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/devices/simulated/simulated_periodic_timer.hpp"
#include "platform/devices/wrapped_device.hpp"
#include "platform/loop/budget_governor.hpp"
#include "platform/loop/haptic_loop.hpp"
#include "platform/loop/supervisor.hpp"
#include "platform/recording/frame_tap.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <random>

/// The controller as `hrtc` assembles it, in virtual time on one thread: scripted operator, device,
/// haptic loop, governor, recording tap, supervisor, and a loader on a link with loss and delay.
/// The scripted machine wakes it late, stalls it and hangs in a reading.
namespace tactus::hrtc::test
{
namespace
{

constexpr std::uint64_t kFrames = 1'000 * TACTUS_VIRTUAL_SECONDS;
constexpr std::uint64_t kHangSpacing = 7'919;
constexpr Duration kHang = milliseconds(8); ///< Long enough for the supervisor.

/// FNV-1a over the input bytes, so that a run is one number.
struct Digest
{
    void add(std::span<const std::byte> bytes)
    {
        for (const std::byte byte : bytes)
        {
            value_ = (value_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100'0000'01B3;
        }
    }
    void add(std::uint64_t number) { add(std::as_bytes(std::span(&number, 1))); }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(Duration duration) { add(static_cast<std::uint64_t>(duration.ns)); }
    void add(const LatencyHistogram& histogram)
    {
        add(histogram.count());
        add(histogram.max());
        add(histogram.mean_ns());
        for (const double q : {0.5, 0.9, 0.99, 0.999})
        {
            add(histogram.quantile(q));
        }
    }

    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_{0xCBF2'9CE4'8422'2325};
};

/// Late wake-ups: one sleep in 40 up to 0.5 ms, one in 900 up to 4 ms, and one in 15,000 as late as
/// the worst observed on a shared virtual machine.
std::vector<LateWake> late_wakes(std::uint32_t seed)
{
    std::mt19937 random(seed);
    std::vector<LateWake> script;
    for (std::uint64_t sleep = 100; sleep < kFrames; ++sleep)
    {
        const auto share = static_cast<std::int64_t>(random() % 1'000 + 1);
        if (sleep % 15'000 == 14'000)
        {
            script.push_back({sleep, microseconds(54 * share)});
        }
        else if (random() % 900 == 0)
        {
            script.push_back({sleep, microseconds(4 * share)});
        }
        else if (random() % 40 == 0)
        {
            script.push_back({sleep, nanoseconds(500 * share)});
        }
    }
    return script;
}

/// Device whose reading takes time, in which the other threads' work is also done.
struct BusyDevice final : WrappedDevice
{
    BusyDevice(std::unique_ptr<HapticDevice> device, std::function<void(std::uint64_t)> meanwhile)
        : WrappedDevice(std::move(device)), meanwhile_(std::move(meanwhile))
    {
    }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        meanwhile_(reads_++);
        return WrappedDevice::read();
    }
    void write(const Wrench& wrench) noexcept override
    {
        WrappedDevice::write(wrench);
        for (const double force_n : wrench.force_world_n)
        {
            written.add(force_n);
        }
    }

    Digest written;

private:
    std::function<void(std::uint64_t)> meanwhile_;
    std::uint64_t reads_{0};
};

tactus::test::RigOptions small_pools_and_a_bad_link()
{
    tactus::test::RigOptions options;
    options.pool_bytes = 1'000'000;
    options.cache_bytes = 400'000;
    options.faults.loss = 0.02;
    options.faults.duplicates = 0.01;
    options.faults.delay_polls_max = 12;
    return options;
}

struct VirtualRun
{
    explicit VirtualRun(std::uint32_t seed)
        : frames_(model(), small_pools_and_a_bad_link())
        , late_wakes_(late_wakes(seed))
        , timer_(clock_, late_wakes_)
        , governor_(microseconds(100), WorkBudget::kLeast, most().work)
        , statistics_(1, 1, 1, kPeriod)
    {
        make_device();
        ToolSetup& tool = tools_.front();
        const DeviceLimits& device = tool.device->info().limits;
        tool.limits = {10.0, device.force_max_n, 500.0, kDampingShare * device.damping_n_s_per_m};
        tool.conditioner.device = device;
        tool.conditioner.period_s = to_seconds(kPeriod);
        loop_.emplace(LoopParts{.frame = &frames_.frame(),
                                .tools = tools_,
                                .timer = &timer_,
                                .clock = &clock_,
                                .budgets = most(),
                                .governor = &governor_,
                                .tap = &tap_,
                                .frames = kFrames},
                      statistics_);
        supervisor_.emplace(
            SupervisorParts{tools_, &loop_->heartbeat(), &clock_, nullptr, kPeriod});
    }

    void run()
    {
        ASSERT_TRUE(timer_.start(kPeriod, microseconds(100)));
        loop_->run();
        take_records();
    }

    [[nodiscard]] const RunStatistics& statistics() const { return statistics_; }
    [[nodiscard]] const TimerCounts& timer_counts() const { return timer_.counts(); }
    [[nodiscard]] const Supervisor& supervisor() const { return *supervisor_; }
    [[nodiscard]] std::uint64_t frames_lost_from() const { return tap_.lost_from(); }
    [[nodiscard]] Duration lasted() const { return clock_.now() - kStart; }
    [[nodiscard]] std::uint64_t events() const { return event_count_; }

    /// Hash of all sent forces.
    [[nodiscard]] std::uint64_t forces() const { return device().written.value(); }
    /// Hash of every frame's inputs and output hashes.
    [[nodiscard]] std::uint64_t recording() const { return recording_.value(); }
    /// Hash of the tools' safety states with times and causes.
    [[nodiscard]] std::uint64_t safety() const { return safety_.value(); }
    /// Hash of all statistics except those of the real machine: faults, switches, allocations.
    [[nodiscard]] std::uint64_t figures() const
    {
        const RunStatistics& s = statistics_;
        Digest digest;
        digest.add(s.frame);
        digest.add(s.wake);
        std::ranges::for_each(s.stages, [&](const auto& stage) { digest.add(stage); });
        for (const std::uint64_t number : {s.frames,
                                           s.answers.exact,
                                           s.answers.separated,
                                           s.answers.bounded,
                                           s.answers.stale,
                                           s.answers.longest_inexact_run,
                                           s.contact_frames,
                                           s.splits,
                                           s.merges,
                                           s.nodes_visited,
                                           s.pages_adopted,
                                           s.cache_hits,
                                           s.cache_misses,
                                           s.evictions,
                                           s.deadlines.missed,
                                           s.work_at_floor,
                                           s.tools.front().halted_frames,
                                           s.models.front().state_hash,
                                           timer_.counts().missed_periods,
                                           timer_.counts().episodes,
                                           supervisor_->brakes()})
        {
            digest.add(number);
        }
        std::ranges::for_each(s.faults, [&](std::uint64_t frames) { digest.add(frames); });
        digest.add(s.work_allowed.sum);
        digest.add(s.work_done.sum);
        digest.add(s.tools.front().max_n);
        digest.add(s.tools.front().max_step_n);
        digest.add(s.answers.width_max_m);
        return digest.value();
    }

private:
    static constexpr MonotonicTime kStart{1'000'000'000};

    /// Model large enough that its pages compete for the cache.
    static const tactus::test::TestModel& model()
    {
        static const tactus::test::TestModel& made = tactus::test::test_model(
            "virtual-run", make_shape(Shape::bumpy_sphere, 20'000).value());
        return made;
    }
    static Budgets most()
    {
        Budgets budgets;
        budgets.work = 100'000;
        return budgets;
    }

    [[nodiscard]] const BusyDevice& device() const
    {
        return static_cast<const BusyDevice&>(*tools_.front().device);
    }

    void make_device()
    {
        OperatorScene scene;
        for (std::size_t i = 0; i < model().faces.size(); i += 37)
        {
            scene.anchors_world_m.push_back(to_vec3(model().faces[i][0]));
        }
        scene.diagonal_m = model().diagonal_m;
        scene.tool_radius_m = 0.01 * model().diagonal_m;
        scene.period = kPeriod;
        scene.frames_total = kFrames;
        auto hand = std::move(ScriptedOperator::create(scene)).value();
        SimulatedDeviceOptions options;
        options.clock = &clock_;
        options.workspace_centre_world_m = hand->centre_world_m();
        options.workspace_radius_m = hand->reach_m();
        tools_.front().device = std::make_unique<BusyDevice>(
            std::move(SimulatedDevice::create(options, std::move(hand))).value(),
            [this](std::uint64_t frame) { work_meanwhile(frame); });
    }

    /// Work of the other threads between two frames, and the time that it and the reading take.
    void work_meanwhile(std::uint64_t frame)
    {
        frames_.deliver();
        take_records();
        const bool hangs = frame % kHangSpacing == kHangSpacing - 1;
        const MonotonicTime end =
            clock_.now() +
            (hangs ? kHang : nanoseconds(20'000 + static_cast<std::int64_t>(frame * 7 % 60'000)));
        while (wake_ <= end)
        {
            clock_.advance_to(wake_);
            wake_ = supervisor_->check();
        }
        clock_.advance_to(end);
    }

    void take_records()
    {
        while (tap_.try_take(coded_frame_))
        {
            recording_.add(coded_frame_);
        }
        events_.clear();
        loop_->safety_log().take_into(events_);
        supervisor_->log().take_into(events_);
        for (const SafetyEvent& event : events_)
        {
            safety_.add(static_cast<std::uint64_t>(event.time.ns));
            safety_.add(event.frame);
            safety_.add(static_cast<std::uint64_t>(event.state));
            safety_.add(static_cast<std::uint64_t>(event.causes));
            safety_.add(static_cast<std::uint64_t>(event.by_supervisor));
        }
        event_count_ += events_.size();
    }

    tactus::test::FrameRig frames_;
    SimulatedClock clock_{kStart};
    std::vector<LateWake> late_wakes_;
    SimulatedPeriodicTimer timer_;
    BudgetGovernor governor_;
    FrameTap tap_;
    RunStatistics statistics_;
    std::array<ToolSetup, 1> tools_;
    std::optional<HapticLoop> loop_;
    std::optional<Supervisor> supervisor_;
    MonotonicTime wake_{kStart};
    std::vector<std::byte> coded_frame_;
    std::vector<SafetyEvent> events_;
    std::uint64_t event_count_{0};
    Digest recording_;
    Digest safety_;
};

TEST(VirtualRun, minutes_of_the_whole_controller_are_the_same_each_time)
{
    VirtualRun first(1);
    first.run();
    // The run has enough events.
    const RunStatistics& figures = first.statistics();
    EXPECT_EQ(figures.frames, kFrames);
    EXPECT_GE(first.lasted(), kPeriod * static_cast<std::int64_t>(kFrames));
    EXPECT_GT(figures.contact_frames, kFrames / 4);
    EXPECT_GT(figures.evictions, std::min<std::uint64_t>(50U, kFrames / 600));
    EXPECT_GT(figures.splits, std::min<std::uint64_t>(5'000U, kFrames / 12));
    EXPECT_GT(figures.tools.front().max_n, 0.5);
    EXPECT_GE(first.supervisor().brakes(), kFrames / kHangSpacing);
    EXPECT_GT(first.timer_counts().episodes, kFrames / kHangSpacing);
    EXPECT_GT(first.timer_counts().missed_periods, first.timer_counts().episodes);
    EXPECT_GT(figures.wake.max(), milliseconds(4));
    EXPECT_EQ(first.frames_lost_from(), kNoFrame);
    EXPECT_GT(first.events(), 2 * kFrames / kHangSpacing);

    VirtualRun again(1);
    again.run();
    EXPECT_EQ(first.forces(), again.forces());
    EXPECT_EQ(first.recording(), again.recording());
    EXPECT_EQ(first.safety(), again.safety());
    EXPECT_EQ(first.figures(), again.figures());
    EXPECT_EQ(first.lasted(), again.lasted());

    VirtualRun other(2); // Other delays must change the result.
    other.run();
    EXPECT_NE(first.forces(), other.forces());
    EXPECT_NE(first.recording(), other.recording());
    EXPECT_NE(first.safety(), other.safety());
    EXPECT_NE(first.figures(), other.figures());
}

} // namespace
} // namespace tactus::hrtc::test
