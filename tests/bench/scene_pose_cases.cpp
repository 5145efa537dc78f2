// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Effect of external poses on a force, and their cost in a frame.

#include "host_tools/shapes/shapes.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scene_cases.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace tactus::bench
{

namespace
{

constexpr std::int64_t kFramesAPose = 10; ///< 100 poses a second.
constexpr Duration kAgeLimit = milliseconds(100);

MonotonicTime time_of(std::int64_t frame)
{
    return MonotonicTime{1'000'000'000} + milliseconds(frame);
}

struct BlendCase
{
    double speed_m_per_s;
    double goal_n;
};

/// Position of the object: a triangle wave at the speed.
double offset_m(double speed_m_per_s, std::int64_t frame)
{
    constexpr double kSwing_m = 0.003;
    const double way_m = speed_m_per_s * 1e-3 * static_cast<double>(frame);
    const double phase = std::fmod(way_m, 4.0 * kSwing_m);
    return phase < 2.0 * kSwing_m ? phase - kSwing_m : 3.0 * kSwing_m - phase;
}

struct ForceSteps
{
    double largest_n{0.0};
    std::uint64_t hash{0};
};

/// Force steps of a tool held 6 mm below the top of a plate of 500 N/m that moves up and down.
ForceSteps force_steps(const Scene& scene, const BlendCase& test_case, bool blends,
                       std::uint32_t frames)
{
    constexpr double kDepth_m = 0.006;
    constexpr double kRadius_m = 0.002;
    test::RigOptions options;
    options.static_when_it_fits = true;
    options.tools = {ToolSpec{kRadius_m, 500.0, 8.0, 1.0}};
    test::FrameRig rig(scene.model, options);
    const Vec3 middle = 0.5 * (scene.tree->low_m() + scene.tree->high_m());
    const Vec3 above = middle + Vec3(0.0, 0.0, scene.model.diagonal_m);
    const double top_m = above.z() - scene.tree->nearest(above).distance_m;
    Vec3 goal(middle.x() + 1e-4, middle.y() + 2e-4, top_m + 2.0 * kRadius_m);
    rig.settle(goal, {}, 3'000);
    for (; goal.z() > top_m + kRadius_m - kDepth_m; goal.z() -= 1e-4)
    {
        rig.step(goal);
    }
    const ObjectPose start = rig.pose();
    SceneMailbox mailbox({&start, 1}, kAgeLimit);
    test::Random random = test::Random::seeded(kSeed);
    ForceSteps steps;
    Vec3 before = Vec3::Zero();
    std::int64_t arrives = 0;
    for (std::int64_t frame = 0; frame < frames; ++frame)
    {
        if (frame % kFramesAPose == 0)
        {
            arrives = frame + static_cast<std::int64_t>(random.below(4)); // Delay up to 3 ms.
        }
        if (frame == arrives)
        {
            const std::int64_t sent = frame - frame % kFramesAPose;
            ObjectPose pose = start;
            pose.translation_m.z() += offset_m(test_case.speed_m_per_s, sent);
            pose.stamp_ns = time_of(sent).ns;
            blends ? mailbox.put(0, pose, time_of(frame)) : rig.place_object(pose);
        }
        mailbox.note_heard(0, time_of(frame));
        for (const SceneChange& change : mailbox.refresh(time_of(frame)))
        {
            rig.place_object(change.pose);
        }
        const FrameOutput output = rig.step(goal);
        const Vec3 force = output.tools[0].force_n;
        if (!output.tools[0].in_contact)
        {
            throw Failure(fmt::format("no contact in frame {}", frame));
        }
        if (frame > 200) // The first pose is 3 mm away.
        {
            steps.largest_n = std::max(steps.largest_n, (force - before).norm());
        }
        before = force;
        steps.hash = steps.hash * 31 + std::bit_cast<std::uint64_t>(force.norm());
    }
    return steps;
}

void run_blend_case(const CaseContext& context, const BlendCase& test_case)
{
    const auto plate = needed(make_thin_plate(20, 0.02));
    const Scene& scene = context.scenes.get(NamedMesh{"plate", plate});
    const std::uint32_t frames = context.options.frames_or(5'000, 2'000);
    const ForceSteps blending = force_steps(scene, test_case, true, frames);
    const ForceSteps jumping = force_steps(scene, test_case, false, frames);
    Row common = context.common_row(scene.model.name, "poses");
    common.frames = frames;
    common.hash = blending.hash;
    CaseRows rows(context.rows, common);
    rows.add("largest step of the force", blending.largest_n, "N", test_case.goal_n);
    rows.add("the same with poses as they come", jumping.largest_n, "N");
}

struct QueueCase
{
    std::uint32_t objects;
    std::uint32_t moving; ///< Objects that move 100 times a second.
};

void run_queue_case(const CaseContext& context, const QueueCase& test_case)
{
    const PinnedCore pinned(context.options.core);
    const std::uint32_t frames = context.options.frames_or(5'000, 1'000);
    const std::vector<ObjectPose> placed(test_case.objects);
    LeastTimes us(frames);
    std::uint64_t hash = test_case.objects;
    for (std::uint32_t pass = 0; pass < context.options.passes_or(5, 2); ++pass)
    {
        SceneMailbox mailbox(placed, kAgeLimit);
        std::int64_t frame = 0;
        const auto put = [&](std::uint32_t object)
        {
            ObjectPose pose;
            pose.translation_m.x() = 1e-5 * static_cast<double>(frame);
            pose.stamp_ns = time_of(frame).ns;
            mailbox.put(object, pose, time_of(frame));
        };
        const auto hear_all = [&]
        {
            for (std::uint32_t i = 0; i < test_case.objects && frame % 20 == 0; ++i)
            {
                mailbox.note_heard(i, time_of(frame));
            }
        };
        for (std::uint32_t i = 0; i < test_case.objects; ++i)
        {
            put(i);
        }
        for (; frame < 200; ++frame) // All objects are tracked, and rest.
        {
            hear_all();
            static_cast<void>(mailbox.refresh(time_of(frame)));
        }
        for (std::uint32_t i = 0; i < frames; ++i, ++frame)
        {
            hear_all();
            for (std::uint32_t moved = 0; moved < test_case.moving && i % kFramesAPose == 0;
                 ++moved)
            {
                put(moved * (test_case.objects / test_case.moving));
            }
            const auto begin = BenchClock::now();
            const auto changes = mailbox.refresh(time_of(frame));
            us.keep(i, microseconds(begin, BenchClock::now()) - clock_cost_us());
            hash = hash * 31 + changes.size();
        }
    }
    Row common = context.common_row("none", "poses");
    common.frames = frames;
    common.hash = hash;
    CaseRows rows(context.rows, common);
    const Spread spread = spread_of(us.least());
    const bool rests = test_case.moving == 0;
    rows.add("poses of a frame, p50", spread.p50, "us", goal_if(rests ? 1.0 : kNoGoal));
    rows.add("poses of a frame, p99", spread.p99, "us");
}

} // namespace

std::vector<Case> scene_pose_cases()
{
    std::vector<Case> cases;
    cases.push_back(
        make_case("moved at 0.1 m/s, 500 N/m", When::always, run_blend_case, BlendCase{0.1, 0.06}));
    for (const QueueCase& test_case : {QueueCase{64, 0}, QueueCase{kMaxObjects, 0},
                                       QueueCase{kMaxObjects, 64}, QueueCase{kMaxObjects, 100}})
    {
        cases.push_back(make_case(
            fmt::format("poses, {} objects, {} moving", test_case.objects, test_case.moving),
            When::always, run_queue_case, test_case));
    }
    return cases;
}

} // namespace tactus::bench
