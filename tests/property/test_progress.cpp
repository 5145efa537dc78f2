// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// No livelock: the smallest budget suffices, and impossible work is not repeated.

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/surface_slide.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

namespace tactus::test
{
namespace
{

/// Tool that reaches slightly beyond the surface without touching it, so that a still goal is a
/// still proxy.
struct NearbyTool
{
    ToolSpec spec;
    Vec3 goal;
};

NearbyTool nearby_tool(const TestModel& model, Random& random, double radius_diag)
{
    const double radius_m = radius_diag * model.diagonal_m;
    return {{radius_m, 500.0, 8.0, 1.0}, place_at_distance(model, random, 1.02 * radius_m)};
}

Budgets with_splits(std::uint32_t splits)
{
    Budgets budgets;
    budgets.splits = splits;
    budgets.merges = splits;
    budgets.nodes = 100'000;
    budgets.triangles = 1'000'000;
    return budgets;
}

struct Effort
{
    std::uint32_t frames{0};
    std::uint32_t splits{0};
    bool exact{false};
};

/// Frames until the answer is exact, with everything loaded before.
Effort run_until_exact(const TestModel& model, const NearbyTool& tool, std::uint32_t splits,
                       std::uint32_t frames_max)
{
    RigOptions options;
    options.tools = {tool.spec};
    FrameRig rig(model, options);
    load_everything(rig);
    Effort run;
    while (!run.exact && run.frames < frames_max)
    {
        const FrameOutput output = rig.step(tool.goal, with_splits(splits));
        ++run.frames;
        run.splits += output.work.splits;
        run.exact = output.pairs[0].kind == AnswerKind::exact;
    }
    return run;
}

using Progress = EachModel<700>;

TEST_P(Progress, one_split_a_frame_is_exact_after_as_many_frames_as_the_closure_has_records)
{
    std::uint32_t closure_max = 0;
    for (int trial = 0; trial < 6; ++trial)
    {
        const NearbyTool tool = nearby_tool(model_, random_, 0.03);
        const Effort unlimited = run_until_exact(model_, tool, kMaxSplitsPerFrame, 50);
        ASSERT_TRUE(unlimited.exact) << "trial " << trial;
        const Effort single = run_until_exact(model_, tool, 1, 4'000);
        EXPECT_TRUE(single.exact) << "trial " << trial;
        // One frame more is allowed, since a frame without a split may be the one that answers.
        // Another order of the records may need a few more.
        EXPECT_LE(single.frames, unlimited.splits + unlimited.splits / 16 + 1)
            << "trial " << trial << ", closure of " << unlimited.splits;
        EXPECT_LE(single.splits, single.frames);
        closure_max = std::max(closure_max, unlimited.splits);
    }
    EXPECT_GT(closure_max, 10U);
}

TEST_P(Progress, the_depth_of_every_closure_is_within_what_the_header_says)
{
    FrameRig rig(model_, with_room_for_all());
    load_everything(rig);
    const Model& model = rig.model();
    const HeaderFields& fields = model.header.fields();
    EXPECT_LE(fields.max_depth, kMaxDepth);
    std::vector<std::uint32_t> depth(fields.records, 0);
    std::uint32_t deepest = 0;
    // Dependencies have higher or lower ids, so the walk has its own stack.
    for (std::uint32_t i = 0; i < fields.records; ++i)
    {
        std::vector<std::uint32_t> stack{i};
        while (!stack.empty())
        {
            const VsplitRecord& record = model.pages.resident(RecordId{stack.back()});
            std::uint32_t below = 0;
            bool waits = false;
            for (std::uint32_t f = 0; f < record.fan_size && !waits; ++f)
            {
                if (const FaceState before = record.before[f]; !before.is_base())
                {
                    const std::uint32_t dependency = before.record().value;
                    waits = depth[dependency] == 0;
                    below = std::max(below, depth[dependency]);
                    if (waits)
                    {
                        stack.push_back(dependency);
                        ASSERT_LE(stack.size(), std::size_t{fields.max_depth})
                            << "record " << i << " has a deeper closure";
                    }
                }
            }
            if (!waits)
            {
                depth[stack.back()] = below + 1;
                EXPECT_EQ(record.depth, below + 1) << "record " << stack.back();
                deepest = std::max(deepest, below + 1);
                stack.pop_back();
            }
        }
    }
    EXPECT_EQ(deepest, fields.max_depth);
}

/// True if nothing changes: no page, no record, no request.
bool is_at_rest(const WorkCounters& work)
{
    return work.splits == 0 && work.merges == 0 && work.pages_adopted == 0 && work.requests == 0 &&
           work.evictions == 0;
}

TEST_P(Progress, a_cache_full_of_pinned_pages_leaves_a_stable_bracket_and_no_thrash)
{
    int open = 0;
    for (std::uint32_t pages = 1; pages <= 12; ++pages)
    {
        SCOPED_TRACE(std::to_string(pages) + " pages");
        const NearbyTool tool = nearby_tool(model_, random_, pages % 2 == 0 ? 0.05 : 0.2);
        RigOptions options;
        options.tools = {tool.spec};
        options.cache_bytes = pages * sizeof(Page);
        FrameRig rig(model_, options);
        FrameOutput output;
        // Unanswered requests are repeated after kRequestTimeoutFrames; none may be left by then.
        for (std::uint32_t frame = 0; frame < 3 * kRequestTimeoutFrames; ++frame)
        {
            output = rig.step(tool.goal);
        }
        const PairOutput settled = output.pairs[0];
        const std::uint64_t hash = output.models[0].state_hash;
        for (std::uint32_t frame = 0; frame < 60; ++frame)
        {
            SCOPED_TRACE("frame " + std::to_string(frame));
            output = rig.step(tool.goal);
            ASSERT_TRUE(is_at_rest(output.work))
                << "splits " << output.work.splits << ", merges " << output.work.merges
                << ", adopted " << output.work.pages_adopted << ", requests "
                << output.work.requests << ", evictions " << output.work.evictions;
            EXPECT_EQ(output.pairs[0].lower_m, settled.lower_m);
            EXPECT_EQ(output.pairs[0].upper_m, settled.upper_m);
            EXPECT_EQ(output.models[0].state_hash, hash);
        }
        ASSERT_TRUE(answer_is_sound(model_, output));
        if (settled.kind == AnswerKind::bounded)
        {
            ++open;
            EXPECT_TRUE(has_fault(output.faults, FrameFault::cache_full));
        }
    }
    EXPECT_GT(open, 3) << "of 12 caches";
}

/// Records split for an incomplete closure.
std::vector<std::uint32_t> held_records(const Model& model)
{
    std::vector<std::uint32_t> held;
    for (std::uint32_t slot = 0; slot < model.pages.capacity(); ++slot)
    {
        const PageTable::Meta& meta = model.pages.meta(slot);
        for (std::uint64_t left = meta.held; left != 0; left &= left - 1)
        {
            held.push_back((meta.chunk.value << kRecordsPerChunkLog2) +
                           static_cast<std::uint32_t>(std::countr_zero(left)));
        }
    }
    return held;
}

TEST_P(Progress, a_record_of_a_pending_closure_is_neither_merged_nor_evicted)
{
    RigOptions options;
    options.tools = {{0.03 * model_.diagonal_m, 500.0, 8.0, 1.0}};
    FrameRig rig(model_, options);
    Budgets one = with_splits(1);
    one.merges = kMaxMergesPerFrame;
    std::set<std::uint32_t> ever_held;
    std::uint32_t merges = 0;
    Vec3 goal(0.0, 0.0, 0.0);
    for (int frame = 0; frame < 900; ++frame)
    {
        if (frame % 90 == 0)
        {
            goal = place_at_distance(model_, random_, 0.0306 * model_.diagonal_m);
        }
        goal += random_.in_cube(5e-4 * model_.diagonal_m);
        const std::vector<std::uint32_t> held = held_records(rig.model());
        merges += rig.step(goal, one).work.merges;
        for (const std::uint32_t record : held)
        {
            EXPECT_TRUE(rig.model().pages.is_refined(RecordId{record}))
                << "frame " << frame << ", record " << record;
        }
        ever_held.insert(held.begin(), held.end());
    }
    EXPECT_GT(ever_held.size(), 5U);
    EXPECT_GT(merges, 5U) << "merging must have been at work beside it";
}

INSTANTIATE_TEST_SUITE_P(small_models, Progress, testing::Range<std::size_t>(0, 6));

/// No region stays refined because pages come and go: after a tool has visited the whole model, the
/// refined records are as few with a small cache as with a complete one.
TEST(Coarsening, what_a_tool_leaves_behind_is_merged_in_a_small_cache_too)
{
    constexpr double kRadius_diag = 0.02;
    constexpr int kFrames = 6'000;
    constexpr int kRest = 200;
    const TestModel& model =
        test_model("bumpy-40k", make_shape(Shape::bumpy_sphere, 40'000).value());
    RigOptions options = with_room_for_all();
    options.tools = {{kRadius_diag * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.tools[0].query_only = true;
    FrameRig roomy(model, options);
    load_everything(roomy);
    options.cache_bytes = std::size_t{1} << 20U;
    FrameRig tight(model, options);
    const FaceTree tree(model.faces);
    Random random(731);
    SlideManner manner;
    manner.diagonal_m = model.diagonal_m;
    manner.radius_diag = kRadius_diag;
    manner.step_m = 0.004 * model.diagonal_m;
    manner.rotation_rad = 0.05;
    manner.rotation_rate = [&](std::uint64_t) { return random.between(-1.0, 1.0); };
    SurfaceSlide slide(tree, manner, place_at_distance(model, random, 0.02 * model.diagonal_m));
    Vec3 goal(0.0, 0.0, 0.0);
    std::uint32_t kept = 0;
    std::uint32_t kept_in_room = 0;
    for (int frame = 0; frame < kFrames + kRest; ++frame)
    {
        goal = frame < kFrames ? slide.next() : goal;
        kept = tight.step({goal}, with_splits(64)).models[0].refined_records;
        kept_in_room = roomy.step({goal}, with_splits(64)).models[0].refined_records;
    }
    EXPECT_GT(tight.model().cache.evictions(), 1'000U) << "the test tests nothing";
    EXPECT_GT(kept, 0U);
    EXPECT_LE(kept, kept_in_room + kept_in_room / 5);
}

} // namespace
} // namespace tactus::test
