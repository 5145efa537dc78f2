// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A model that fits the pools ends up fully refined, and then frames only query.

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/frame_verdict.hpp"

#include <algorithm>

namespace tactus::test
{
namespace
{

class StaticMode : public EachModel<1'200>
{
protected:
    static constexpr std::uint32_t kFramesMax = 4'000;

    static RigOptions static_options()
    {
        RigOptions options;
        options.pool_bytes = std::size_t{32} << 20U;
        options.static_when_it_fits = true;
        return options;
    }
    /// Random place up to a tenth of the diagonal from a vertex.
    Vec3 random_place()
    {
        const Face& face = model_.faces[random_.below(model_.faces.size())];
        const Vec3 corner_m = to_vec3(face[random_.below(3)]);
        return corner_m + random_.in_cube(0.1 * model_.diagonal_m);
    }
    /// Steps with a moving tool; every answer meanwhile holds.
    std::uint32_t frames_until_static(FrameRig& rig, const Budgets& budgets)
    {
        std::uint32_t frames = 0;
        Vec3 goal = random_place();
        for (bool is_static = false; !is_static && frames < kFramesMax; ++frames)
        {
            goal += random_.in_cube(0.002 * model_.diagonal_m);
            const FrameOutput output = rig.step(goal, budgets);
            EXPECT_TRUE(answer_is_sound(model_, output)) << "frame " << frames;
            is_static = output.models[0].is_static;
        }
        return frames;
    }
};

TEST_P(StaticMode, a_model_that_fits_ends_refined_and_frames_only_query)
{
    FrameRig sut(model_, static_options());
    if (frames_until_static(sut, {}) == kFramesMax)
    {
        // Faces of needles share few vertices: the blocks run out before the faces.
        const PoolUse blocks = sut.step(random_place()).models[0].blocks;
        EXPECT_GT(blocks.used_max + AbTree::kReserve + kMaxStarFaces, blocks.capacity);
        EXPECT_EQ(sut.model().residence, Residence::partial);
        return;
    }
    EXPECT_EQ(sut.model().forest.active_faces(), model_.faces.size());
    EXPECT_EQ(sut.model().forest.refined_records(), sut.model().header.counts().records);

    for (int frame = 0; frame < 100; ++frame)
    {
        SCOPED_TRACE(frame);
        const FrameOutput output = sut.step(random_place());
        const WorkCounters& work = output.work;
        EXPECT_TRUE(output.models[0].is_static);
        EXPECT_EQ(work.splits + work.merges + work.scanned, 0U);
        EXPECT_EQ(work.blocks_refitted + work.nodes_refitted, 0U);
        EXPECT_EQ(work.pages_adopted + work.requests + work.regions_searched, 0U);
        const PairOutput& pair = output.pairs[0];
        EXPECT_NE(pair.kind, AnswerKind::bounded);
        EXPECT_TRUE(answer_is_sound(model_, output));
        if (pair.kind == AnswerKind::exact)
        {
            EXPECT_NEAR(pair.lower_m, pair.upper_m, 1e-12 * model_.diagonal_m);
        }
    }
}

/// Records that are split to fill the pools also add faces that the question needs.
TEST_P(StaticMode, says_what_it_lacks_while_it_fills)
{
    for (int place = 0; place < 20; ++place)
    {
        FrameRig sut(model_, static_options());
        const Vec3 goal = random_place();
        for (int frame = 0; frame < 30; ++frame)
        {
            const Verdict verdict = unexplained(sut.step(goal));
            ASSERT_FALSE(verdict) << *verdict << ", place " << place << ", frame " << frame;
        }
    }
}

TEST_P(StaticMode, comes_to_it_with_one_split_a_frame_and_a_link_that_loses)
{
    RigOptions options = static_options();
    options.faults.loss = 0.2;
    options.faults.seed = seed_;
    FrameRig sut(model_, options);
    Budgets few;
    few.splits = 1;
    few.requests = 2;
    const std::uint32_t records = sut.model().header.counts().records;
    Vec3 goal = random_place();
    std::uint32_t refined = 0;
    for (std::uint32_t frame = 0; frame < kFramesMax; ++frame)
    {
        goal += random_.in_cube(0.002 * model_.diagonal_m);
        const FrameOutput output = sut.step(goal, few);
        ASSERT_LE(output.work.splits, 1U);
        refined = std::max(refined, output.models[0].refined_records);
        if (output.models[0].is_static)
        {
            break;
        }
    }
    // The number depends on the time: refinement behind the tool may be merged and split again.
    EXPECT_GE(refined, std::min(records, kFramesMax / 4));
}

/// More chunks than the transport side has requests for, and slow pieces.
TEST(StaticModeFarAway, is_reached_and_what_the_tool_needs_comes_first)
{
    const TestModel& model =
        test_model("far-away", make_shape(Shape::bumpy_sphere, 60'000).value());
    RigOptions options;
    options.pool_bytes = std::size_t{64} << 20U;
    options.static_when_it_fits = true;
    options.chunk_loader_steps_per_frame = 1;
    options.faults.delay_polls_min = options.faults.delay_polls_max = 20;
    FrameRig sut(model, options);
    const Vec3 goal = to_vec3(model.faces[0][0]);
    std::uint32_t first_exact = 0;
    std::uint32_t first_static = 0;
    for (std::uint32_t frame = 1; frame <= 4'000 && first_static == 0; ++frame)
    {
        const FrameOutput output = sut.step(goal);
        const bool is_exact = output.pairs[0].kind == AnswerKind::exact;
        first_exact = first_exact == 0 && is_exact ? frame : first_exact;
        first_static = output.models[0].is_static ? frame : 0;
    }
    EXPECT_GT(first_exact, 0U);
    EXPECT_LT(first_exact, 300U); // A round trip for each level of the index, and the splits.
    EXPECT_GT(first_static, 0U);
    EXPECT_EQ(sut.chunk_loader().counters().forgotten, 0U);
}

INSTANTIATE_TEST_SUITE_P(small_models, StaticMode,
                         testing::Range<std::size_t>(0, small_models().size()));

TEST(StaticModeIsLeftAlone, when_the_pages_or_the_faces_do_not_fit)
{
    const TestModel& model = small_model(0);
    Random random = Random::seeded(seed_of(1'210));
    for (const bool few_pages : {false, true})
    {
        RigOptions options;
        options.static_when_it_fits = true;
        if (few_pages)
        {
            options.cache_bytes = 5 * sizeof(Page);
        }
        else
        {
            options.pool_bytes = std::size_t{500} << 10U;
        }
        FrameRig sut(model, options);
        ASSERT_FALSE(sut.model().fits());
        for (int frame = 0; frame < 300; ++frame)
        {
            const Face& face = model.faces[random.below(model.faces.size())];
            const FrameOutput output = sut.step(to_vec3(face[0]));
            EXPECT_FALSE(output.models[0].is_static);
            EXPECT_TRUE(answer_is_sound(model, output)) << "frame " << frame;
        }
    }
}

} // namespace
} // namespace tactus::test
