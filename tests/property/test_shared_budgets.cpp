// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I8: budgets are kept and shared by the frame; what one model uses is not missing in another for
/// long. Pools are shared too: pages of one model may serve another, except for a reserve.

#include "tests/property/frame_checks.hpp"

#include <array>

namespace tactus::test
{
namespace
{

/// One tool and two copies of a model, each with its own object.
FrameRig two_models(const TestModel& model)
{
    RigOptions options;
    options.tools = {{0.03 * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.objects = {{ModelId{0}}, {ModelId{1}}};
    return FrameRig(std::vector{&model, &model}, options);
}

std::uint32_t refined(FrameRig& rig, std::uint32_t model)
{
    return rig.model({model}).forest.refined_records();
}

ObjectPose away_from(const TestModel& model)
{
    ObjectPose away;
    away.translation_m = Vec3(0.0, 0.0, 20.0 * model.diagonal_m);
    return away;
}

/// Goal that swings along a line beside the surface, so far that records are split and left behind.
Vec3 swinging(const TestModel& model, const Vec3& place, int frame)
{
    const double phase = static_cast<double>(frame % 80) / 40.0;
    const double along = phase < 1.0 ? phase : 2.0 - phase;
    return place + Vec3(0.0, 0.0, 0.05 * along * model.diagonal_m);
}

TEST(SharedBudgets, one_split_a_frame_refines_both_models)
{
    const TestModel& model = small_model(0);
    Random random = Random::seeded(seed_of(800));
    FrameRig sut = two_models(model);
    const Vec3 place = place_at_distance(model, random, 0.0306 * model.diagonal_m);
    Budgets one;
    one.splits = 1;
    std::uint32_t refined_min = 0;
    for (int frame = 0; frame < 400; ++frame)
    {
        static_cast<void>(sut.step(swinging(model, place, frame), one));
        refined_min = std::max(refined_min, std::min(refined(sut, 0), refined(sut, 1)));
    }
    EXPECT_GT(refined_min, 5U) << "one of the models was left coarse throughout";
}

TEST(SharedBudgets, a_model_that_was_left_coarsens_while_another_is_scanned)
{
    const TestModel& model = small_model(0);
    for (std::size_t left = 0; left < 2; ++left)
    {
        Random random = Random::seeded(seed_of(801));
        FrameRig sut = two_models(model);
        const Vec3 place = place_at_distance(model, random, 0.0306 * model.diagonal_m);
        Budgets few;
        few.scanned = 8;
        for (int frame = 0; frame < 320; ++frame)
        {
            static_cast<void>(sut.step(swinging(model, place, frame), few));
        }
        const auto which = static_cast<std::uint32_t>(left);
        ASSERT_GT(refined(sut, which), 20U);
        sut.place_object(away_from(model), left);
        for (int frame = 0; frame < 2'000 && refined(sut, which) > 0; ++frame)
        {
            static_cast<void>(sut.step(swinging(model, place, frame), few));
        }
        EXPECT_EQ(refined(sut, which), 0U) << "model " << left;
    }
}

/// All pages for a sphere arrive at once, before the next frame.
TEST(WorstCases, a_full_inbox_is_adopted_a_few_pages_a_frame)
{
    const TestModel& model = small_model(0);
    RigOptions options;
    options.tools = {{0.2 * model.diagonal_m, 500.0, 8.0, 1.0}};
    FrameRig sut(model, options);
    Budgets budgets;
    budgets.requests = 64;
    const Vec3 goal = to_vec3(model.faces[0][0]);
    for (int frame = 0; frame < 2; ++frame) // First the index page, then the chunks it names.
    {
        static_cast<void>(sut.step_without_delivery({goal}, budgets, {}));
        for (int i = 0; i < 100; ++i)
        {
            sut.deliver();
        }
    }
    const auto waiting =
        static_cast<std::uint32_t>(sut.frame().pools().cache.queues.arrived.size());
    ASSERT_GT(waiting, 12U) << "not enough to fill a frame's share";
    budgets.pages = 3;
    std::uint32_t adopted = 0;
    for (std::uint32_t frame = 0; frame < waiting / 3; ++frame)
    {
        const FrameOutput output = sut.step_without_delivery({goal}, budgets, {});
        EXPECT_LE(output.work.pages_adopted, budgets.pages);
        ASSERT_TRUE(answer_is_sound(model, output)) << "frame " << frame;
        adopted += output.work.pages_adopted;
    }
    EXPECT_GE(adopted, waiting / 3) << "updates of links may stand between arrivals";
}

TEST(SharedPools, a_touch_uses_faces_that_another_model_brought_and_that_keeps_its_part)
{
    const TestModel& model = small_model(0);
    RigOptions options;
    options.pool_bytes = std::size_t{1'200} << 10U;
    options.cache_bytes = std::size_t{600} << 10U;
    options.objects = {{ModelId{0}}, {ModelId{1}}};
    options.tools = {{0.3 * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.tools[0].query_only = true;
    FrameRig rig({&model, &model}, options);
    const Vec3 place = to_vec3(model.faces[0][0]);
    std::array<std::uint32_t, 2> most{};
    for (std::size_t touched = 0; touched < 2; ++touched)
    {
        rig.place_object({}, touched);
        rig.place_object(away_from(model), 1 - touched);
        for (int frame = 0; frame < 400; ++frame)
        {
            const FrameOutput output = rig.step(place);
            for (std::size_t i = 0; i < 2; ++i)
            {
                most[i] = std::max(most[i], output.models[i].faces.used);
                const PoolUse& faces = output.models[i].faces;
                const std::uint32_t base = rig.model({0}).header.counts().base_faces;
                ASSERT_LE(faces.used, 2 * faces.capacity - base - (faces.capacity - base) / 4);
            }
        }
        EXPECT_GT(most[touched], rig.model({0}).capacities.faces) << "it used its own part only";
    }
}

TEST(SharedPools, a_touch_takes_pages_that_are_of_no_use_elsewhere_but_for_those_kept_there)
{
    const TestModel& model = small_model(0);
    RigOptions options;
    options.cache_bytes = 16 * sizeof(Page);
    options.objects = {{ModelId{0}}, {ModelId{1}}};
    options.tools = {{0.3 * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.tools[0].query_only = true;
    FrameRig rig({&model, &model}, options);
    const Vec3 place = to_vec3(model.faces[0][0]);
    const std::uint32_t brought = rig.model({0}).capacities.pages;
    ASSERT_EQ(brought, 8U);
    std::array<std::uint32_t, 2> used{};
    for (std::size_t turn = 0; turn < 4; ++turn)
    {
        const std::size_t touched = turn % 2;
        rig.place_object({}, touched);
        rig.place_object(away_from(model), 1 - touched);
        const std::uint32_t had = used[1 - touched];
        for (int frame = 0; frame < 600; ++frame)
        {
            const FrameOutput output = rig.step(place);
            used = {output.models[0].pages.used, output.models[1].pages.used};
            ASSERT_LE(used[0] + used[1], 2 * brought);
            ASSERT_GE(used[1 - touched], std::min(had, brought / 4)) << "what is kept was taken";
        }
        EXPECT_GT(used[touched], brought) << "turn " << turn;
        EXPECT_EQ(used[1 - touched], std::min(had, brought / 4)) << "turn " << turn;
    }
}

} // namespace
} // namespace tactus::test
