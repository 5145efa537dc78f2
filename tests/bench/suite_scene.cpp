// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `scene`: cost of a touch among many objects and of a scene at rest, with the greatest
/// error of the reported distances against all objects.

#include "host_tools/shapes/shapes.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"
#include "tests/stability/whole_model.hpp"
#include "transport/pool_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <vector>

namespace tactus::bench
{
namespace
{

// Effect of external poses on a force, and their cost in a frame.

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
    constexpr double kHeldDepth_m = 0.006;
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
    for (; goal.z() > top_m + kRadius_m - kHeldDepth_m; goal.z() -= 1e-4)
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

/// Variant of a scene without a shortcut.
struct WithoutShortcut
{
    const char* name;
    bool FrameVariant::*shortcut; ///< Shortcut to leave out; null: none.
};
constexpr std::array<WithoutShortcut, 5> kWithoutShortcut{
    {{"all shortcuts", nullptr},
     {"all objects near", &FrameVariant::finds_neighbours},
     {"no rest out of reach", &FrameVariant::lets_pairs_rest},
     {"no rest of tools", &FrameVariant::lets_tools_rest},
     {"no rest of frames", &FrameVariant::lets_frames_rest}}};

struct SceneCase
{
    std::uint32_t objects;
    std::uint32_t tools;
    std::uint32_t moving; ///< Objects that move a little in each frame.
    /// Variant; null: all shortcuts, and nothing to compare.
    const WithoutShortcut* without{nullptr};
};

constexpr SceneSource kObject{"bumpy-20k", nullptr, 0, 20'000};
/// Distance between the centres of neighbours in diagonals: none touches another.
constexpr double kApart_diag = 1.5;
constexpr double kSlide_diag_per_s = 0.5;
/// Frames between two checks of all distances.
constexpr std::uint32_t kJudgedEvery = 97;

/// Objects on a grid, the touched one at its corner.
class Crowd
{
public:
    Crowd(const SceneCase& test_case, const Scene& scene, std::uint32_t frames)
        : scene_(scene), moving_(test_case.moving)
    {
        const double radius_m = 0.01 * scene.model.diagonal_m;
        options_.pool_bytes = std::size_t{16} << 20U;
        options_.static_when_it_fits = true;
        if (test_case.without != nullptr && test_case.without->shortcut != nullptr)
        {
            options_.variant.*test_case.without->shortcut = false;
        }
        options_.tools.assign(test_case.tools,
                              ToolSpec{radius_m, 500.0, 8.0, 2.0 * scene.model.diagonal_m});
        options_.objects.assign(test_case.objects, ObjectSpec{ModelId{0}});
        const auto side = static_cast<std::uint32_t>(
            std::ceil(std::cbrt(static_cast<double>(test_case.objects))));
        for (std::uint32_t i = 0; i < test_case.objects; ++i)
        {
            ObjectPose pose;
            pose.translation_m = kApart_diag * scene.model.diagonal_m *
                                 Vec3(i % side, i / side % side, i / side / side);
            options_.poses.push_back(pose);
        }
        goals_m_ = slide_motion(scene.touch(), kSlide_diag_per_s, frames);
    }

    /// Runs every frame once, timed, or with occasional checks of the truth, which evict the
    /// caches. The first tool touches the first object while the others rest between four objects;
    /// or all rest.
    void run(bool touches, std::size_t frames, LeastTimes* us)
    {
        test::FrameRig rig(scene_.model, options_);
        std::vector<Vec3> goals(options_.tools.size());
        for (std::size_t i = 0; i < goals.size(); ++i)
        {
            goals[i] = kApart_diag * scene_.model.diagonal_m *
                       Vec3(static_cast<double>(i) + 0.5, 0.5, 0.0);
        }
        test::refine_fully(scene_.model.name,
                           [&](const Budgets& budgets) { return rig.step(goals, budgets); });
        for (std::size_t i = 0; i < kApproachFrames && touches; ++i)
        {
            goals[0] = goals_m_[i];
            rig.step(goals, {});
        }
        StageTimer timer;
        for (std::size_t i = 0; i < frames; ++i)
        {
            goals[0] = touches ? goals_m_[kApproachFrames + i] : goals[0];
            move(rig, i);
            rig.deliver();
            timer.begin();
            const FrameOutput output = counted_step(rig, goals, {}, timer.mark());
            touching_.resize(frames);
            touching_[i] = output.tools[0].in_contact;
            hash_ = hash_ * 31 + output.models[0].state_hash + output.pairs.size() +
                    std::bit_cast<std::uint64_t>(output.pairs[0].lower_m);
            if (us != nullptr)
            {
                us->keep(i, timer.sum_us());
            }
            else if (i % kJudgedEvery == 0)
            {
                judge(rig, output);
            }
        }
    }

    [[nodiscard]] double error_m() const { return error_m_; }
    [[nodiscard]] std::uint64_t hash() const { return hash_; }
    /// Times of frames in which the last run's first tool was in contact.
    [[nodiscard]] std::vector<double> touching(const std::vector<double>& times_us) const
    {
        return chosen(times_us, touching_);
    }

private:
    /// Moves the last objects to and fro.
    void move(test::FrameRig& rig, std::size_t frame)
    {
        const auto objects = static_cast<std::uint32_t>(options_.objects.size());
        for (std::uint32_t i = 0; i < std::min(moving_, objects - 1); ++i)
        {
            const std::uint32_t object = objects - 1 - i;
            ObjectPose pose = options_.poses[object];
            pose.translation_m.z() +=
                1e-3 * scene_.model.diagonal_m * std::sin(0.05 * static_cast<double>(frame));
            rig.place_object(pose, object);
        }
    }

    /// Checks bounds and clearances; a failure if one does not hold.
    void judge(const test::FrameRig& rig, const FrameOutput& output)
    {
        for (std::uint32_t tool = 0; tool < output.tools.size(); ++tool)
        {
            const Vec3 center = rig.frame().tool(tool).placement().place.translation_m;
            double nearest_other_m = kInfinity;
            for (std::uint32_t object = 0; object < options_.objects.size(); ++object)
            {
                const double truth_m =
                    scene_.tree->nearest(to_model(rig.pose(object), center)).distance_m;
                const auto pair =
                    std::ranges::find_if(output.pairs, [tool, object](const PairOutput& one)
                                         { return one.tool == tool && one.object == object; });
                if (pair == output.pairs.end())
                {
                    nearest_other_m = std::min(nearest_other_m, truth_m);
                    continue;
                }
                const double beyond_m = std::max(pair->lower_m - truth_m, truth_m - pair->upper_m);
                if (pair->kind == AnswerKind::exact)
                {
                    error_m_ = std::max(error_m_, beyond_m);
                }
                if (beyond_m > 1e-12 * scene_.model.diagonal_m)
                {
                    throw Failure(fmt::format("tool {} is {} m from object {}, not {} to {}", tool,
                                              truth_m, object, pair->lower_m, pair->upper_m));
                }
            }
            if (output.tools[tool].clear_m > nearest_other_m * (1.0 + 1e-12))
            {
                throw Failure(
                    fmt::format("tool {} is said to be clear by {} m and has something at {}", tool,
                                output.tools[tool].clear_m, nearest_other_m));
            }
        }
    }

    const Scene& scene_;
    std::uint32_t moving_;
    test::RigOptions options_;
    std::vector<Vec3> goals_m_;
    double error_m_{0.0};
    std::vector<bool> touching_; ///< Contact flags by frame.
    std::uint64_t hash_{0};
};

/// Bytes of one more object in the pools.
double bytes_an_object(std::uint32_t tools)
{
    const std::vector<ToolSpec> specs(tools);
    const auto bytes = [&](std::uint32_t objects)
    {
        FrameSetup setup;
        setup.tools = specs;
        setup.capacities = {objects, kMaxPairs};
        return static_cast<double>(Frame::required_bytes(setup));
    };
    return (bytes(kMaxObjects) - bytes(64)) / (kMaxObjects - 64);
}

void run_scene_case(const CaseContext& context, const SceneCase& test_case)
{
    const Scene& scene = context.scenes.get(kObject);
    const PinnedCore pinned(context.options.core);
    const std::uint32_t frames = context.options.frames_or(2'000, 400);
    Crowd crowd(test_case, scene, frames);
    if (context.options.count)
    {
        LeastTimes nobody_reads(frames);
        crowd.run(true, frames, &nobody_reads);
        if (test_case.without != nullptr)
        {
            crowd.run(false, frames, &nobody_reads);
        }
        return;
    }
    Crowd alone({1, 1, 0}, scene, frames);
    LeastTimes touch_us(frames);
    LeastTimes rest_us(frames);
    LeastTimes alone_us(frames);
    const std::uint32_t passes = context.options.passes_or(3, 2);
    for (const bool touches : {true, false})
    {
        crowd.run(touches, frames, nullptr);
    }
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        crowd.run(true, frames, &touch_us);
        alone.run(true, frames, &alone_us);
    }
    const std::vector<double> crowd_us = crowd.touching(touch_us.least());
    const std::vector<double> single_us = alone.touching(alone_us.least());
    if (crowd_us.empty() || crowd_us.size() != single_us.size())
    {
        throw Failure(
            fmt::format("in contact in {} frames, alone in {}", crowd_us.size(), single_us.size()));
    }
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        crowd.run(false, frames, &rest_us);
    }
    Row common = context.common_row(scene.model.name);
    common.setting = fmt::format("{} tools, {} moving", test_case.tools, test_case.moving);
    common.test_case = fmt::format("{} objects", test_case.objects);
    if (test_case.without != nullptr)
    {
        common.setting += fmt::format(", {}", test_case.without->name);
    }
    common.frames = frames;
    common.hash = crowd.hash();
    CaseRows rows(context.rows, common);
    const Spread touch = spread_of(crowd_us);
    const Spread rest = spread_of(rest_us.least());
    const Spread by_itself = spread_of(single_us);
    const bool has_goal =
        test_case.objects == 1'000 && test_case.tools == 1 && test_case.moving == 0;
    rows.add("touch p50", touch.p50, "us");
    rows.add("touch p99", touch.p99, "us");
    rows.add("p50 by that of one object", touch.p50 / by_itself.p50, "",
             goal_if(has_goal ? 1.1 : kNoGoal));
    rows.add("p99 by that of one object", touch.p99 / by_itself.p99, "",
             goal_if(has_goal ? 1.15 : kNoGoal));
    rows.add("rest p50", rest.p50, "us",
             goal_if(test_case.moving == 0 && test_case.without == nullptr
                         ? 0.2 + 0.1 * test_case.tools
                         : kNoGoal));
    rows.add("rest p99", rest.p99, "us");
    const auto counted = count_instructions(context);
    if (counted)
    {
        const bool is_compared = test_case.without != nullptr;
        rows.add(is_compared ? "touch and rest instructions" : "touch instructions",
                 static_cast<double>(*counted) / (is_compared ? 2 * frames : frames), "/frame");
    }
    rows.add("object", bytes_an_object(test_case.tools), "B", 256.0);
    rows.add("error max", crowd.error_m() / scene.model.diagonal_m, "diag", 1e-14);
}

// Smallest pools in which a scene of large models starts.

constexpr SceneSource kLarge{"bumpy-200k", nullptr, 0, 200'000};

struct PoolCase
{
    std::uint32_t models;
    std::uint32_t tools;
    double goal_mib;
};

/// Memory by `--pool-mib` if each model is shown by one object; checks that a frame runs in it.
void run_pool_case(const CaseContext& context, const PoolCase& test_case)
{
    const Scene& scene = context.scenes.get(kLarge);
    const test::TestModel& model = scene.model;
    const auto served = needed(serve_from_file(model.path, model.name, {}));
    test::RigOptions options;
    options.tools.assign(test_case.tools, ToolSpec{0.01 * model.diagonal_m});
    for (std::uint32_t i = 0; i < test_case.models; ++i)
    {
        options.objects.push_back({ModelId{i}});
    }
    options.poses.resize(test_case.models);
    FrameSetup setup;
    setup.tools = options.tools;
    setup.objects = options.objects;
    setup.poses = options.poses;
    const std::vector<ModelHeader> headers(test_case.models,
                                           ModelHeader::parse(served.header).value());
    options.pool_bytes = least_pool_bytes(setup, headers, 0);
    test::FrameRig rig(std::vector(test_case.models, &model), options);
    const FrameOutput output =
        rig.step(std::vector<Vec3>(test_case.tools, to_vec3(model.faces[0][0])), {});
    if (output.pairs.size() != std::size_t{test_case.models} * test_case.tools)
    {
        throw Failure(fmt::format("{} pairs are answered of {} models and {} tools",
                                  output.pairs.size(), test_case.models, test_case.tools));
    }
    Row common = context.common_row(model.name);
    common.test_case = fmt::format("{} models of 200,000 faces", test_case.models);
    common.setting = fmt::format("{} tools", test_case.tools);
    CaseRows rows(context.rows, common);
    rows.add("least pool", static_cast<double>(options.pool_bytes + sizeof(Frame)) / 0x1p20, "MiB",
             goal_if(test_case.goal_mib));
}

std::vector<Case> scene_cases()
{
    std::vector<Case> cases;
    for (const std::uint32_t objects : {1U, 10U, 100U, 1'000U, kMaxObjects})
    {
        for (const std::uint32_t tools : {1U, 4U, kMaxTools})
        {
            for (const std::uint32_t moving : {0U, 64U})
            {
                if (moving == 0 || objects > moving)
                {
                    cases.push_back(make_case(
                        fmt::format("{} objects, {} tools, {} moving", objects, tools, moving),
                        When::always, run_scene_case, SceneCase{objects, tools, moving}));
                }
            }
        }
    }
    for (const WithoutShortcut& without : kWithoutShortcut)
    {
        // All objects may be near each tool.
        const SceneCase test_case{kMaxPairs / 4, 4, 0, &without};
        cases.push_back(
            make_case(fmt::format("{} objects, 4 tools, {}", test_case.objects, without.name),
                      When::always, run_scene_case, test_case));
    }
    for (const PoolCase& test_case : {PoolCase{1, 1, kNoGoal}, PoolCase{8, 4, 2.0}})
    {
        cases.push_back(
            make_case(fmt::format("pool of {} models, {} tools", test_case.models, test_case.tools),
                      When::always, run_pool_case, test_case));
    }
    std::ranges::move(scene_pose_cases(), std::back_inserter(cases));
    std::ranges::move(scene_wire_cases(), std::back_inserter(cases));
    return cases;
}

} // namespace

Suite scene_suite()
{
    return {"scene", scene_cases};
}

} // namespace tactus::bench
