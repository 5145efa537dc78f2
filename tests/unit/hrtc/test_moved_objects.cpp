// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/limits.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

namespace tactus::hrtc::test
{
namespace
{

/// Change of a fading force between frames.
constexpr double kFadeStep_n = 8.0 * kPeriod_s / kFadeTime_s;

/// Object whose pose is sent before each frame in which `shift_m` gives its displacement in x; the
/// hand descends on it in -x.
struct MovedObject
{
    using Shift = std::function<std::optional<double>(std::uint64_t frame)>;

    explicit MovedObject(Shift shift, double speed_m_per_s = kInfinity)
        : shift_(std::move(shift)), rig_(options(speed_m_per_s))
    {
    }

    void run() { rig_.loop().run(); }
    [[nodiscard]] LoopRig& rig() { return rig_; }
    /// Mean norm of the force over 50 frames.
    [[nodiscard]] double force_n(std::uint64_t frame)
    {
        double sum = 0.0;
        for (std::uint64_t i = frame; i < frame + 50; ++i)
        {
            sum += rig_.written_n(i).norm();
        }
        return sum / 50.0;
    }

private:
    LoopRigOptions options(double speed_m_per_s)
    {
        return {.tamper =
                    [this](std::uint64_t frame, DeviceSample&)
                {
                    if (const auto shift_m = shift_(frame))
                    {
                        ObjectPose pose = rig_.placed();
                        pose.translation_m.x() += *shift_m;
                        rig_.mailbox().put(0, pose, rig_.clock().now());
                    }
                },
                .has_mailbox = true,
                .object_speed_m_per_s = speed_m_per_s};
    }

    Shift shift_;
    LoopRig rig_;
};

/// Displacement up and down by `most_m`, a cosine over 400 frames from kSettled on.
std::optional<double> swing(std::uint64_t frame, double most_m)
{
    const double phase = std::clamp((static_cast<double>(frame) - kSettled) / 400.0, 0.0, 1.0);
    return 0.5 * most_m * (1.0 - std::cos(2.0 * 3.14159265358979 * phase));
}

TEST(MovedObject, pushes_the_hand_that_touches_it_and_lets_go_again)
{
    constexpr double kMost_m = 0.002;
    MovedObject sut([](std::uint64_t frame) { return swing(frame, kMost_m); });
    sut.run();
    const double before_n = sut.force_n(kSettled - 50);
    const double pushed_n = sut.force_n(kSettled + 175);
    const double after_n = sut.force_n(1'800);
    EXPECT_GT(before_n, 1.0);
    // The hand yields: a fifth of the force at the wall's 500 N/m remains.
    EXPECT_GT(pushed_n, before_n + 500.0 * kMost_m / 5.0);
    EXPECT_NEAR(after_n, before_n, 0.05 * before_n);
    EXPECT_LE(sut.rig().largest_step_n(kSettled, 1'900), 500.0 * kMost_m / 10.0);
    EXPECT_EQ(sut.rig().statistics().answers.stale, 0U);
    EXPECT_FALSE(LoopRig::has(sut.rig().events(), ForceOff::jump));
    EXPECT_NEAR(static_cast<double>(sut.rig().mailbox().uses()[0].moves), 400.0, 1.0);
}

TEST(MovedObject, whose_poses_stop_loses_the_force_and_gets_it_back_with_them)
{
    constexpr std::uint64_t kSilence = 400;
    const auto is_silent = [](std::uint64_t frame)
    { return frame >= kSettled && frame < kSettled + kSilence; };
    MovedObject sut([&](std::uint64_t frame)
                    { return is_silent(frame) ? std::nullopt : std::optional(0.0); });
    sut.run();
    // The last pose arrived at the start of frame kSettled - 1: 100 frames later its age is at the
    // limit.
    const double before_n = sut.force_n(kSettled);
    EXPECT_NEAR(sut.rig().written_n(kSettled + 99).norm(), before_n, 0.05 * before_n);
    EXPECT_LT(sut.rig().written_n(kSettled + 110).norm(), 0.9 * before_n);
    EXPECT_EQ(sut.rig().written_n(kSettled + 152).norm(), 0.0);
    EXPECT_EQ(sut.rig().written_n(kSettled + kSilence - 1).norm(), 0.0);
    EXPECT_NEAR(sut.force_n(1'800), before_n, 0.05 * before_n);
    EXPECT_LE(sut.rig().largest_step_n(kSettled, 1'900), kBackStep_n);
    EXPECT_EQ(sut.rig().statistics().answers.stale, kSilence - 100U);
    EXPECT_EQ(sut.rig().mailbox().uses()[0].old_frames, kSilence - 100U);
    EXPECT_TRUE(LoopRig::has(sut.rig().events(), ForceOff::stale));
}

TEST(MovedObject, that_nobody_moves_never_grows_old)
{
    MovedObject sut([](std::uint64_t) { return std::nullopt; });
    sut.run();
    EXPECT_GT(sut.force_n(1'800), 1.0);
    EXPECT_EQ(sut.rig().statistics().answers.stale, 0U);
    EXPECT_FALSE(sut.rig().mailbox().uses()[0].is_followed);
}

/// Distance of a force from the nearest fading of the last one.
double growth_n(const Vec3& before_n, const Vec3& now_n)
{
    double least = kInfinity;
    for (int share = 0; share <= 1'000; ++share)
    {
        least = std::min(least, (now_n - 1e-3 * share * before_n).norm());
    }
    return least;
}

/// The device's limit is 8 N, the wall has 500 N/m: 16 mm at once is a jump. The hand is then
/// pushed out from deep inside, and the force falls along its path.
TEST(MovedObject, that_jumps_under_the_tool_makes_no_step_of_the_force)
{
    for (const double jump_m : {0.02, 0.2, -0.02, -0.2})
    {
        MovedObject sut([jump_m](std::uint64_t frame)
                        { return std::optional(frame < kSettled ? 0.0 : jump_m); });
        sut.run();
        EXPECT_TRUE(LoopRig::has(sut.rig().events(), ForceOff::jump)) << jump_m;
        EXPECT_LE(sut.rig().largest_step_n(kSettled - 1, kSettled + 50), kBackStep_n) << jump_m;
        for (std::uint64_t frame = kSettled; frame < 1'900; ++frame)
        {
            ASSERT_LE(growth_n(sut.rig().written_n(frame - 1), sut.rig().written_n(frame)),
                      kBackStep_n)
                << jump_m << " m, frame " << frame;
        }
    }
}

TEST(MovedObject, that_goes_15_mm_at_once_is_followed)
{
    MovedObject sut([](std::uint64_t frame)
                    { return std::optional(frame < kSettled ? 0.0 : -0.015); });
    sut.run();
    EXPECT_FALSE(LoopRig::has(sut.rig().events(), ForceOff::jump));
    EXPECT_NEAR(sut.rig().written_n(1'800).norm(), 0.0,
                kRounding_n); // The object has left the hand.
    EXPECT_GT(sut.rig().largest_step_n(kSettled - 1, 1'900), kFadeStep_n);
}

/// 60 mm at 2 m/s, towards the hand and away from it.
TEST(MovedObject, that_outruns_what_is_believed_lets_the_force_fade)
{
    for (const double speed_m_per_s : {2.0, -2.0})
    {
        const auto run_away = [=](std::uint64_t frame)
        {
            const double since = std::clamp(static_cast<double>(frame) - kSettled, 0.0, 30.0);
            return std::optional(speed_m_per_s * kPeriod_s * since);
        };
        MovedObject sut(run_away, 0.5);
        sut.run();
        EXPECT_LE(sut.rig().largest_step_n(kSettled, 1'900),
                  1.3 * 500.0 * 0.5 * kPeriod_s + kFadeStep_n)
            << speed_m_per_s;
        const std::vector<SafetyEvent> events = sut.rig().events();
        const auto first =
            std::ranges::find_if(events, [](const SafetyEvent& event)
                                 { return has_cause(event.causes, ForceOff::jump); });
        ASSERT_NE(first, events.end()) << speed_m_per_s;
        EXPECT_LE(first->frame, kSettled + 10U) << speed_m_per_s; // 10 mm ahead by then.
    }
}

/// Object that moves towards a hand descending at 0.05 m/s, at once or with poses for each frame,
/// `before` frames before the touch.
struct Strike
{
    double way_m;
    std::uint64_t before;
    int frames;
};

/// First frame with a force on an object at rest.
std::uint64_t first_touch()
{
    static const std::uint64_t kFrame = []
    {
        MovedObject sut([](std::uint64_t) { return std::optional(0.0); });
        sut.run();
        std::uint64_t frame = 0;
        while (sut.rig().written_n(frame).norm() == 0.0)
        {
            ++frame;
        }
        return frame;
    }();
    return kFrame;
}

struct Felt
{
    double growth_n{0.0}; ///< Greatest growth in a frame.
    double step_m{0.0};   ///< Greatest step of the object in a frame.
    bool is_jump{false};
};

Felt felt_of(const Strike& strike, double speed_m_per_s)
{
    const double start = static_cast<double>(first_touch()) - static_cast<double>(strike.before);
    MovedObject sut(
        [=](std::uint64_t frame)
        {
            const double done = (static_cast<double>(frame) - start) / strike.frames;
            return std::optional(strike.way_m * std::clamp(done, 0.0, 1.0));
        },
        speed_m_per_s);
    sut.run();
    Felt felt;
    for (std::uint64_t frame = 1; frame < kSettled; ++frame)
    {
        felt.growth_n = std::max(felt.growth_n, sut.rig().written_n(frame).norm() -
                                                    sut.rig().written_n(frame - 1).norm());
    }
    felt.step_m = sut.rig().mailbox().uses()[0].step_max_m;
    felt.is_jump = LoopRig::has(sut.rig().events(), ForceOff::jump);
    return felt;
}

/// Strikes from 0.2 to 3.3 mm before the touch. The force grows at most by 0.5 m/s and the hand's
/// motion in a frame at 500 N/m, and by the slew of the change limit; it fades while the object
/// exceeds its speed limit.
TEST(MovedObject, that_strikes_before_the_touch_is_carried_no_faster_than_is_believed)
{
    for (const double way_m : {0.012, 0.015, 0.025})
    {
        for (const std::uint64_t before : {5U, 20U, 80U})
        {
            for (const int frames : {1, 4})
            {
                SCOPED_TRACE(std::to_string(way_m) + " m, " + std::to_string(before) +
                             " frames before, in " + std::to_string(frames));
                const Felt felt = felt_of({way_m, before, frames}, 0.5);
                EXPECT_LE(felt.growth_n, 500.0 * (0.5e-3 + 5e-5) + 0.08);
                EXPECT_LE(felt.step_m, 0.501e-3);
                EXPECT_TRUE(felt.is_jump || way_m < 0.02);
                EXPECT_GT(felt_of({way_m, before, frames}, kInfinity).step_m, 0.24 * way_m);
            }
        }
    }
}

/// Object that jumps over a hand at rest before it, unlimited by all stages except the last one.
/// That one permits 0.5 mm of motion, and the slew.
TEST(MovedObject, that_leaps_over_a_hand_is_felt_step_by_step_whatever_is_believed_of_it)
{
    const std::array<std::pair<DeviceLimits, double>, 2> devices{
        {{kOmegaClass, 0.5}, {kTouchClass, 0.25}}};
    for (const auto& [device, most_n] : devices)
    {
        for (const double leap_m : {0.012, 0.015, 0.025})
        {
            for (const double off_m : {0.0002, 0.001, 0.004})
            {
                LoopRig rig({.meanwhile =
                                 [leap_m](LoopRig& running, std::uint64_t frame)
                             {
                                 ObjectPose pose = running.placed();
                                 pose.translation_m.x() += frame < kSettled ? 0.0 : leap_m;
                                 running.mailbox().put(0, pose, running.clock().now());
                             },
                             .has_mailbox = true,
                             .change_speed_m_per_s = 0.5,
                             .device = device,
                             .press_m = -off_m - 0.01 * tactus::test::small_model(0).diagonal_m});
                rig.run();
                double growth = 0.0;
                double felt_n = 0.0;
                for (std::uint64_t frame = kSettled; frame < 1'900; ++frame)
                {
                    growth =
                        std::max(growth, growth_n(rig.written_n(frame - 1), rig.written_n(frame)));
                    felt_n = std::max(felt_n, rig.written_n(frame).norm());
                }
                EXPECT_EQ(rig.largest_step_n(0, kSettled - 1), 0.0) << "before it nothing is felt";
                EXPECT_LE(growth, most_n) << leap_m << " m from " << off_m << " m";
                EXPECT_GT(felt_n, 1.0) << leap_m << " m from " << off_m << " m";
                EXPECT_GT(rig.frames_with(ForceAction::change_limited), 0U);
                std::printf("leap of %.0f mm from %.1f mm, device of %.1f N: %.3f N a period, %.1f "
                            "N at most\n",
                            1e3 * leap_m, 1e3 * off_m, device.force_max_n, growth, felt_n);
            }
        }
    }
}

TEST(MovedObject, of_an_honest_server_is_felt_as_if_all_were_believed)
{
    const auto shift = [](std::uint64_t frame) { return swing(frame, 0.02); }; // 0.16 m/s.
    MovedObject limited(shift);
    MovedObject sut(shift, 0.5);
    limited.run();
    sut.run();
    for (std::uint64_t frame = 0; frame < 2'000; ++frame)
    {
        ASSERT_EQ(sut.rig().written_n(frame), limited.rig().written_n(frame)) << frame;
    }
    EXPECT_EQ(sut.rig().mailbox().uses()[0].rate_limited_frames, 0U);
}

} // namespace
} // namespace tactus::hrtc::test
