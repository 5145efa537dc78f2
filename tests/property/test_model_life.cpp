// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Models of which a frame starts with the header alone: they are loaded when a tool is near, enter
/// in slices, answer correctly from the first frame on, and are removed again.

#include "platform/recording/replay_queues.hpp"
#include "tests/property/replay_checks.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"
#include "tests/stability/scene_trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr double kSide_m = 10.0; ///< Distance between two models, out of each other's reach.

ModelCounts counts_of(const TestModel& model)
{
    const auto served = serve_from_file(model.path, model.name, {});
    return ModelHeader::parse(served.value().header).value().counts();
}

/// Pools for `meshes` base meshes of the largest model, with the needs of touching.
ModelCapacities room_for(const std::vector<const TestModel*>& models, std::uint32_t meshes)
{
    std::uint32_t cells = 0;
    for (const TestModel* model : models)
    {
        cells = std::max(cells, BaseMesh::cells_of(counts_of(*model)));
    }
    ModelCapacities room;
    room.base_cells = meshes * cells;
    room.faces = meshes * cells + 4'000;
    room.blocks = room.faces / 8 + 2 * AbTree::kReserve * (meshes + 1);
    room.nodes = room.blocks / 2 + 2 * AbTree::kReserve * (meshes + 1);
    room.pages = 128;
    room.index_pages = 16;
    return room;
}

/// `count` models in a row, each shown once, with capacity for some of them.
struct Row
{
    Row(std::uint32_t count, std::uint32_t meshes, const LoopbackFaults& faults = {},
        bool query_only = false, bool record = false, std::uint32_t kinds = 3,
        std::uint32_t tools = 1)
    {
        options.record = record;
        for (std::uint32_t i = 0; i < count; ++i)
        {
            models.push_back(&small_model(i % kinds));
            options.objects.push_back(ObjectSpec{ModelId{i}});
            ObjectPose pose;
            pose.translation_m = Vec3(kSide_m * i, 0.0, 0.0);
            options.poses.push_back(pose);
        }
        options.for_streamed_models = room_for(models, meshes);
        options.faults = faults;
        options.tools.assign(tools, ToolSpec{0.01 * models[0]->diagonal_m, 500.0, 8.0, 1.0});
        options.tools[0].query_only = query_only;
        rig.emplace(models, options);
    }
    /// Place above the model's highest vertex.
    [[nodiscard]] Vec3 above(std::uint32_t model, double height_m) const
    {
        const auto top = std::ranges::max_element(models[model]->faces, {},
                                                  [](const Face& face) { return face[0][2]; });
        return to_vec3(top->at(0)) + Vec3(kSide_m * model, 0.0, height_m);
    }
    ModelStage step(std::uint32_t model, double height_m)
    {
        output = rig->step(above(model, height_m));
        return output.models[model].stage;
    }
    /// Frames until the model is in that stage, at most 4,000.
    std::uint32_t until(ModelStage stage, std::uint32_t model, std::uint32_t tool_at,
                        double height_m)
    {
        std::uint32_t frames = 0;
        while (frames < 4'000 && output.models.size() > 0 && output.models[model].stage != stage)
        {
            step(tool_at, height_m);
            ++frames;
        }
        return frames;
    }

    std::vector<const TestModel*> models;
    RigOptions options;
    std::optional<FrameRig> rig;
    FrameOutput output;
};

std::uint32_t used_by(const ModelOutput& model)
{
    return model.pages.used + model.index_pages.used + model.faces.used + model.blocks.used +
           model.nodes.used;
}

TEST(ModelLife, goes_from_known_to_known_by_way_of_every_stage)
{
    Row sut(2, 2);
    sut.step(1, 0.05);
    std::vector<ModelStage> stages{sut.output.models[0].stage};
    EXPECT_EQ(stages.back(), ModelStage::known);
    EXPECT_EQ(used_by(sut.output.models[0]), 0U);
    std::uint32_t leaving = 0;
    for (int i = 0; i < 3'500; ++i)
    {
        const std::uint32_t faces_before = sut.output.models[0].faces.used;
        sut.step(i < 500 ? 0 : 1, 0.02);
        const ModelStage stage = sut.output.models[0].stage;
        const std::uint32_t faces = sut.output.models[0].faces.used;
        if (stages.back() == ModelStage::arriving)
        {
            EXPECT_LE(faces, faces_before + kEnteringFacesPerFrame);
        }
        if (stage == ModelStage::leaving)
        {
            ++leaving;
            EXPECT_LE(faces_before, faces + kLeavingFacesPerFrame);
        }
        if (stage != stages.back())
        {
            stages.push_back(stage);
        }
    }
    const std::vector<ModelStage> expected{ModelStage::known,    ModelStage::wanted,
                                           ModelStage::arriving, ModelStage::resident,
                                           ModelStage::leaving,  ModelStage::known};
    const std::uint32_t slots =
        sut.options.for_streamed_models.pages + sut.options.for_streamed_models.index_pages;
    EXPECT_GE(leaving, (slots + kLeavingSlotsPerFrame - 1) / kLeavingSlotsPerFrame);
    // The model may enter within one frame, and is then never seen arriving.
    std::erase(stages, ModelStage::arriving);
    std::vector<ModelStage> seen = expected;
    std::erase(seen, ModelStage::arriving);
    EXPECT_EQ(stages, seen);
    EXPECT_EQ(used_by(sut.output.models[0]), 0U);
    const ModelPools& pools = sut.rig->frame().pools();
    EXPECT_EQ(pools.base_room.used(), BaseMesh::cells_of(counts_of(*sut.models[1])));
    EXPECT_EQ(pools.faces.used(), sut.output.models[1].faces.used);
    EXPECT_EQ(sut.rig->model({0}).linker.pages_here(), 0U);
    EXPECT_FALSE(sut.rig->model({0}).linker.has_base());
}

TEST(ModelLife, the_model_left_longest_ago_makes_room_for_one_that_is_wanted)
{
    Row sut(4, 2, {}, false, false, 1); // One size, so that any two fit.
    sut.step(0, 0.05);
    EXPECT_LT(sut.until(ModelStage::resident, 0, 0, 0.05), 200U);
    std::uint32_t before = 0;
    for (const std::uint32_t model : {1U, 2U, 3U, 2U, 1U, 0U}) // Adjacent models.
    {
        EXPECT_LT(sut.until(ModelStage::resident, model, model, 0.05), 200U);
        for (const std::uint32_t any : {0U, 1U, 2U, 3U})
        {
            EXPECT_EQ(sut.output.models[any].stage == ModelStage::resident,
                      any == model || any == before)
                << model << " " << any;
        }
        before = model;
    }
}

/// A resting hand may start at any speed.
TEST(ModelLife, is_wanted_as_soon_as_a_tool_that_rests_is_near)
{
    for (const double away_m : {0.12, 0.3})
    {
        SCOPED_TRACE(away_m);
        Row sut(2, 2);
        const Vec3 tool_m = sut.above(0, 0.05);
        double low_m = kInfinity;
        for (const Face& face : sut.models[1]->faces)
        {
            for (const Vec3f& corner : face)
            {
                low_m = std::min(low_m, static_cast<double>(corner[0]));
            }
        }
        ObjectPose pose;
        pose.translation_m = tool_m - sut.above(1, 0.0) + Vec3(kSide_m, 0.0, 0.0);
        pose.translation_m.x() = tool_m.x() + sut.options.tools[0].radius_m + away_m - low_m;
        sut.rig->place_object(pose, 1);
        for (int i = 0; i < 50; ++i)
        {
            sut.step(0, 0.05);
        }
        EXPECT_EQ(sut.output.models[1].stage == ModelStage::known, away_m > 0.2);
    }
}

/// The tool is held at the box's border without a force, and the frames are counted.
TEST(ModelLife, a_tool_stops_before_a_model_whose_server_is_gone_and_goes_on_when_it_is_back)
{
    Row sut(1, 1);
    sut.rig->link().lose_server();
    const double radius_m = sut.options.tools[0].radius_m;
    std::uint32_t walled = 0;
    for (int i = 0; i < 600; ++i)
    {
        sut.step(0, std::max(0.3 - 0.001 * i, -0.05));
        const ToolOutput& tool = sut.output.tools[0];
        ASSERT_GE((tool.proxy_m - sut.above(0, 0.0)).z(), radius_m * (1.0 - 1e-9)) << i;
        EXPECT_EQ(tool.force_n.norm(), 0.0) << i;
        walled += sut.output.scene.walled_tools;
    }
    EXPECT_GT(walled, 200U);
    EXPECT_EQ(sut.output.models[0].stage, ModelStage::wanted);
    sut.rig->link().regain_server();
    EXPECT_LT(sut.until(ModelStage::resident, 0, 0, 0.05), 50U);
    EXPECT_EQ(sut.rig->chunk_loader().counters().overdue, 0U);
    for (int i = 0; i < 300; ++i)
    {
        sut.step(0, 0.5 * radius_m);
    }
    EXPECT_GT(sut.output.tools[0].force_n.norm(), 0.0);
    EXPECT_EQ(sut.output.scene.walled_tools, 0U);
}

/// A silent server blocks nothing permanently: its model becomes known again, and is requested
/// later while the tool stays.
TEST(ModelLife, a_model_whose_server_is_silent_gives_its_room_to_others_and_comes_when_it_speaks)
{
    Row sut(2, 1, {}, false, true, 1);
    sut.rig->link({0}).lose_server();
    sut.step(0, 0.05);
    EXPECT_LT(sut.until(ModelStage::wanted, 0, 0, 0.05), 5U);
    std::vector<ModelStage> stages{ModelStage::wanted};
    std::uint32_t knows = 0;
    for (int i = 0; i < 3'000; ++i)
    {
        const ModelStage stage = sut.step(0, 0.05);
        knows += stage == ModelStage::known ? 1U : 0U;
        ASSERT_TRUE(stage == ModelStage::known || stage == ModelStage::wanted);
        const std::uint32_t used = sut.rig->frame().pools().base_room.used();
        ASSERT_EQ(used > 0, stage == ModelStage::wanted) << i;
        if (stage != stages.back())
        {
            stages.push_back(stage);
        }
    }
    EXPECT_GT(stages.size(), 4U);
    EXPECT_GT(knows, 200U);
    EXPECT_LT(knows, 1'000U);
    EXPECT_EQ(sut.rig->chunk_loader().counters(0).overdue, stages.size() / 2);
    // Another model occupies the memory.
    EXPECT_LT(sut.until(ModelStage::resident, 1, 1, 0.05), 1'500U);
    EXPECT_EQ(sut.output.models[0].stage, ModelStage::known);
    sut.rig->link({0}).regain_server();
    EXPECT_LT(sut.until(ModelStage::resident, 0, 0, 0.05), 400U);
    expect_same_again(sut.rig->finish_recording());
}

/// All servers are silent, and the memory holds one model. The nearest waits for that of the next,
/// which frees it in a frame in which the farthest may be requested too.
TEST(ModelLife, room_that_is_given_back_is_for_the_most_urgent_one_that_waits)
{
    Row sut(3, 1, {}, false, false, 1);
    const auto place = [&sut](std::uint32_t model, double deep_m)
    {
        ObjectPose pose;
        pose.translation_m = Vec3(0.0, 0.0, -deep_m);
        sut.rig->place_object(pose, model);
    };
    for (const std::uint32_t model : {0U, 1U, 2U})
    {
        sut.rig->link({model}).lose_server();
    }
    place(0, 0.03);
    EXPECT_LT(sut.until(ModelStage::wanted, 0, 0, 0.05), 5U);
    place(1, 0.0);
    place(2, 0.06);
    sut.step(0, 0.05);
    ASSERT_EQ(sut.output.pairs.size(), 3U);
    EXPECT_LT(sut.until(ModelStage::known, 0, 0, 0.05), 2'000U);
    EXPECT_EQ(sut.output.models[2].stage, ModelStage::known);
    sut.step(0, 0.05);
    EXPECT_EQ(sut.output.models[1].stage, ModelStage::wanted);
    EXPECT_EQ(sut.output.models[2].stage, ModelStage::known);
}

/// Answers take 20 ms; the hand moves at 2 m/s towards the model and away.
TEST(ModelLife, no_hand_at_two_metres_a_second_meets_an_invisible_wall_at_20_ms)
{
    Row sut(4, 2, {.delay_polls_min = 80, .delay_polls_max = 80});
    std::uint64_t walled = 0;
    std::uint64_t touched = 0;
    const double radius_m = sut.options.tools[0].radius_m;
    for (const std::uint32_t model : {0U, 1U, 2U, 3U, 0U})
    {
        for (int i = 0; i < 600; ++i)
        {
            sut.step(model, std::max(0.6 - 0.002 * i, radius_m));
            walled += sut.output.scene.walled_tools;
        }
        touched += sut.output.pairs[0].kind == AnswerKind::exact ? 1U : 0U;
    }
    EXPECT_EQ(walled, 0U);
    EXPECT_EQ(touched, 5U);
}

TEST(ModelLife, a_base_mesh_that_is_damaged_on_its_way_is_refused_and_brought_again)
{
    Row sut(1, 1, {.seed = seed_of(2'401), .damage = 0.7});
    sut.step(0, 0.05);
    EXPECT_LT(sut.until(ModelStage::resident, 0, 0, 0.05), 4'000U);
    EXPECT_GT(sut.rig->chunk_loader().counters().refused_hash, 0U);
    EXPECT_EQ(sut.rig->chunk_loader().counters().refused_content, 0U);
}

/// Objects are added, moved and removed, tools wander and jump, pieces are late and lost: the
/// bounds always hold. With memory for two of three models one is always in transit. If no answer
/// becomes exact, as with 3 of 8 seeds in 250 frames, the next seeds count as well.
TEST(ModelLife, every_answer_is_true_in_any_order_of_coming_and_going)
{
    const std::vector<const TestModel*> models{&small_model(0), &small_model(1), &small_model(2)};
    RigOptions options = with_room_for_all();
    options.tools.assign(3, ToolSpec{0.01 * models[0]->diagonal_m, 500.0, 8.0, 1.0});
    options.capacities.objects = 24;
    options.faults = {.loss = 0.02, .delay_polls_max = 16};
    options.for_streamed_models = room_for(models, 2);
    SceneFigures all;
    const std::uint64_t first = seed_of(2'410);
    for (std::uint64_t seed = first; seed < first + 12 && all.exact < 20; ++seed)
    {
        all.add(run_scene_trial({models, {"streamed_models", {}, options}, 3, seed, 250}));
    }
    EXPECT_TRUE(all.truth.holds()) << all.truth.summary();
    EXPECT_GE(all.truth.trials, 250U);
    EXPECT_GE(all.exact, 20U);
}

/// Laws of streamed models for all tools, links and servers. Distances are those of FaceTree, which
/// shares no code with the product.
class Laws
{
public:
    Laws(Row& row, std::uint64_t seed) : row_(row), random_(seed)
    {
        for (const TestModel* model : row.models)
        {
            trees_.emplace_back(model->faces);
            cells_.push_back(BaseMesh::cells_of(counts_of(*model)));
        }
        stages_.assign(row.models.size(), ModelStage::known);
        goals_.assign(row.options.tools.size(), row.above(0, 0.05));
        silent_until_.assign(row.models.size(), 0);
    }

    /// Tools hop between models, sink in, and rest; servers fall silent and answer again.
    void wander(std::uint32_t frames)
    {
        for (std::uint32_t frame = 0; frame < frames; ++frame)
        {
            for (Vec3& goal : goals_)
            {
                goal += 0.001 * random_.in_cube(1.0);
                goal = random_.one_in(120) ? place_near(random_.below(models())) : goal;
            }
            for (std::uint32_t i = 0; i < models(); ++i)
            {
                if (silent_until_[i] == frame && frame > 0)
                {
                    row_.rig->link({i}).regain_server();
                }
                if (silent_until_[i] <= frame && random_.one_in(400))
                {
                    row_.rig->link({i}).lose_server();
                    silent_until_[i] = frame + 1 + random_.below(1'500U);
                }
            }
            ASSERT_NO_FATAL_FAILURE(step(frame));
        }
    }

    /// All servers answer and the tools rest on models that fit together: finally these are
    /// resident, with exact answers.
    void rest()
    {
        for (std::uint32_t i = 0; i < models(); ++i)
        {
            row_.rig->link({i}).regain_server();
        }
        for (Vec3& goal : goals_)
        {
            goal = row_.above(random_.below(models()), 0.3 * row_.options.tools[0].radius_m);
        }
        for (std::uint32_t frame = 0; frame < 1'500; ++frame)
        {
            ASSERT_NO_FATAL_FAILURE(step(frame));
        }
        for (const PairOutput& pair : output_.pairs)
        {
            // Other models may also have pairs, without memory.
            EXPECT_TRUE(pair.lower_m > 1.0 || stages_[pair.object] == ModelStage::resident)
                << pair.object << " of " << output_.pairs.size() << ", tool " << pair.tool << " L "
                << pair.lower_m << " U " << pair.upper_m;
            if (pair.lower_m < 2.0 * row_.options.tools[0].radius_m)
            {
                EXPECT_EQ(pair.kind, AnswerKind::exact);
                const double truth_m = distance_m(pair);
                EXPECT_NEAR(pair.lower_m, truth_m, 1e-12);
                EXPECT_NEAR(pair.upper_m, truth_m, 1e-12);
                ++exact_at_rest_;
            }
        }
    }

    [[nodiscard]] std::uint32_t changes() const { return changes_; }
    [[nodiscard]] std::uint32_t given_back() const { return given_back_; }
    [[nodiscard]] std::uint32_t exact_at_rest() const { return exact_at_rest_; }

private:
    [[nodiscard]] std::uint32_t models() const
    {
        return static_cast<std::uint32_t>(row_.models.size());
    }
    [[nodiscard]] Vec3 place_near(std::uint32_t model)
    {
        const Vec3 top = row_.above(model, 0.02);
        return top + random_.in_cube(0.1);
    }
    [[nodiscard]] double distance_m(const PairOutput& pair) const
    {
        return trees_[pair.object]
            .nearest(to_model(row_.rig->pose(pair.object), pair.point_m))
            .distance_m;
    }

    void step(std::uint32_t frame)
    {
        SCOPED_TRACE(frame);
        output_ = row_.rig->step(goals_, {});
        std::uint32_t cells = 0;
        std::uint32_t faces = 0;
        for (std::uint32_t i = 0; i < models(); ++i)
        {
            const ModelOutput& model = output_.models[i];
            ASSERT_TRUE(may_follow(stages_[i], model.stage))
                << i << ": from " << kModelStageNames[static_cast<std::size_t>(stages_[i])]
                << " to " << kModelStageNames[static_cast<std::size_t>(model.stage)];
            given_back_ +=
                stages_[i] == ModelStage::wanted && model.stage == ModelStage::known ? 1U : 0U;
            const bool leaves =
                model.stage == ModelStage::leaving && stages_[i] != ModelStage::leaving;
            const double reach_m = 2.0 * row_.options.tools[0].radius_m;
            ASSERT_FALSE(leaves && std::ranges::any_of(
                                       output_.pairs, [&](const PairOutput& pair)
                                       { return pair.object == i && pair.lower_m < reach_m; }))
                << i << " leaves while a tool is near";
            changes_ += stages_[i] != model.stage ? 1U : 0U;
            cells += model.stage == ModelStage::known ? 0 : cells_[i];
            faces += model.faces.used;
            if (model.stage == ModelStage::known || model.stage == ModelStage::wanted)
            {
                ASSERT_EQ(used_by(model), 0U) << i;
            }
        }
        const ModelPools& pools = row_.rig->frame().pools();
        ASSERT_EQ(cells, pools.base_room.used());
        ASSERT_LE(cells, row_.options.for_streamed_models.base_cells);
        ASSERT_EQ(faces, pools.faces.used());
        ASSERT_LE(faces, row_.options.for_streamed_models.faces);
        for (const PairOutput& pair : output_.pairs)
        {
            const double truth_m = distance_m(pair);
            ASSERT_LE(pair.lower_m, truth_m + 1e-12);
            ASSERT_GE(pair.upper_m, truth_m - 1e-12);
            ASSERT_TRUE(pair.kind != AnswerKind::exact ||
                        stages_[pair.object] == ModelStage::resident);
            ASSERT_TRUE(pair.kind != AnswerKind::exact || pair.upper_m - pair.lower_m <= 1e-12);
        }
        for (std::uint32_t i = 0; i < models(); ++i)
        {
            stages_[i] = output_.models[i].stage;
        }
    }

    /// Permitted stages in the next frame, including ones that end at once: a small base mesh
    /// enters when it arrives, and one without a tool nearby may have to leave then.
    static bool may_follow(ModelStage before, ModelStage after)
    {
        using enum ModelStage;
        switch (before)
        {
        case known:
            return after <= wanted;
        case wanted:
            return true;
        case arriving:
            return after >= arriving;
        case resident:
            return after >= resident;
        case leaving:
            return after == leaving || after == known;
        }
        return false;
    }

    Row& row_;
    Random random_;
    std::vector<FaceTree> trees_;
    std::vector<std::uint32_t> cells_;
    std::vector<ModelStage> stages_; ///< Stages after the last frame.
    std::vector<Vec3> goals_;
    std::vector<std::uint32_t> silent_until_;
    FrameOutput output_;
    std::uint32_t changes_{0};
    std::uint32_t given_back_{0};
    std::uint32_t exact_at_rest_{0};
};

/// Memory for three of the largest models suffices for two wanted ones under any fragmentation.
TEST(ModelLife, laws_hold_whatever_tools_links_and_servers_do)
{
    std::uint32_t changes = 0;
    std::uint32_t given_back = 0;
    std::uint32_t exact = 0;
    for (std::uint64_t seed = 2'430; seed < 2'434; ++seed)
    {
        SCOPED_TRACE(seed_of(seed));
        Row row(5, 2U + static_cast<std::uint32_t>(seed % 2),
                {.seed = seed_of(seed), .loss = 0.05, .delay_polls_max = 60}, false, false, 3, 2);
        Laws sut(row, seed_of(seed));
        ASSERT_NO_FATAL_FAILURE(sut.wander(1'500));
        ASSERT_NO_FATAL_FAILURE(sut.rest());
        changes += sut.changes();
        given_back += sut.given_back();
        exact += sut.exact_at_rest();
    }
    EXPECT_GT(changes, 100U);
    EXPECT_GT(given_back, 1U);
    EXPECT_EQ(exact, 8U); // Each tool has one each time.
}

/// Five models near one tool, with memory for two.
struct Crowd : Row
{
    Crowd() : Row(5, 2, {}, false, false, 1)
    {
        for (std::uint32_t i = 0; i < 5; ++i)
        {
            ObjectPose pose;
            pose.translation_m = aside_m(i);
            rig->place_object(pose, i);
        }
    }
    [[nodiscard]] Vec3 aside_m(std::uint32_t model) const
    {
        return {0.7 * models[0]->diagonal_m * model, 0.0, 0.0};
    }
    void step_above(std::uint32_t model, double height_m)
    {
        output = rig->step(Vec3(above(0, height_m) + aside_m(model)));
    }
};

/// The nearest models are resident at every place of the tool.
TEST(ModelLife, what_is_touched_has_room_though_pairs_are_of_all)
{
    Crowd sut;
    std::size_t pairs = 0;
    for (const std::uint32_t model : {0U, 4U, 1U, 3U, 2U, 0U})
    {
        for (int i = 0; i < 1'200; ++i)
        {
            const double height_m = std::max(0.3 - 0.001 * i, 0.5 * sut.options.tools[0].radius_m);
            sut.step_above(model, height_m);
        }
        pairs = std::max(pairs, sut.output.pairs.size());
        EXPECT_EQ(sut.output.models[model].stage, ModelStage::resident) << model;
        EXPECT_TRUE(sut.output.tools[0].in_contact) << model;
        EXPECT_EQ(sut.output.scene.walled_tools, 0U) << model;
    }
    EXPECT_GT(pairs, 2U);
}

TEST(ModelLife, what_is_here_stays_while_another_is_as_near)
{
    Crowd sut;
    for (int i = 0; i < 600; ++i)
    {
        sut.step_above(2, 0.05); // Two neighbours on either side, one of them resident.
    }
    const auto stages = [&sut]
    {
        std::vector<ModelStage> all;
        std::ranges::transform(sut.output.models, std::back_inserter(all), &ModelOutput::stage);
        return all;
    };
    const std::vector<ModelStage> settled = stages();
    EXPECT_EQ(std::ranges::count(settled, ModelStage::resident), 2);
    for (int i = 0; i < 1'000; ++i)
    {
        sut.step_above(2, 0.05);
        ASSERT_EQ(stages(), settled) << i;
        ASSERT_GT(sut.output.pairs.size(), 2U);
    }
}

/// Fully resident models answer as in a frame that had them from the start.
TEST(ModelLife, a_model_that_came_and_one_that_was_here_from_the_start_are_refined_alike)
{
    Row sut(1, 1, {}, true); // The path does not depend on earlier models.
    RigOptions options = with_room_for_all();
    options.tools = sut.options.tools;
    FrameRig from_start(*sut.models[0], options);
    sut.step(0, 0.05);
    EXPECT_LT(sut.until(ModelStage::resident, 0, 0, 0.05), 200U);
    Random random(seed_of(2'420));
    for (int place = 0; place < 40; ++place)
    {
        const Vec3 goal = sut.above(0, 0.02) + random.in_cube(0.05);
        sut.rig->settle(goal, {}, 400);
        from_start.settle(goal, {}, 400);
        const FrameOutput came = sut.rig->step(goal);
        const FrameOutput was = from_start.step(goal);
        ASSERT_EQ(came.pairs[0].kind, was.pairs[0].kind) << place;
        ASSERT_NEAR(came.pairs[0].lower_m, was.pairs[0].lower_m, 1e-9) << place;
    }
}

TEST(ModelLife, a_run_with_models_that_come_and_go_replays_bit_for_bit)
{
    Row sut(4, 2, {.loss = 0.02, .delay_polls_max = 16}, false, true);
    for (const std::uint32_t model : {0U, 1U, 2U, 3U, 0U})
    {
        for (int i = 0; i < 60; ++i)
        {
            sut.step(model, 0.02);
        }
    }
    EXPECT_TRUE(std::ranges::any_of(sut.output.models, [](const ModelOutput& model)
                                    { return model.stage != ModelStage::resident; }));
    expect_same_again(sut.rig->finish_recording(), 300);
}

/// Frame that requests a base mesh, with a replay's queues before it.
struct WantedBase : Row
{
    WantedBase() : Row(1, 1, {}, false, true)
    {
        step(0, 0.05);
        EXPECT_LT(until(ModelStage::resident, 0, 0, 0.05), 200U);
        auto parsed = Recording::parse(rig->finish_recording(), "base");
        EXPECT_TRUE(parsed);
        recording.emplace(std::move(parsed).value());
        options.record = false;
        rig.emplace(models, options);
        while (rig->frame().model({0}).stage != ModelStage::wanted)
        {
            run();
        }
        queues.emplace(*recording, rig->frame());
    }
    void run() { output = rig->step_without_delivery({above(0, 0.05)}, {}, {}); }
    /// Result of the queues for these events of the model's base mesh.
    std::optional<std::string> open(const std::vector<QueueEventKind>& kinds,
                                    std::uint32_t freed_taken = 0)
    {
        const SpscQueue<PieceRequest>& wanted = rig->frame().pools().cache.queues.wanted;
        RecordedFrame frame;
        frame.request_room = static_cast<std::uint32_t>(wanted.capacity() - wanted.size());
        for (const QueueEventKind kind : kinds)
        {
            frame.events.push_back({{ContentKind::base, 0}, 0, freed_taken, 0, kind, 0});
        }
        return queues->open(frame);
    }

    std::optional<Recording> recording;
    std::optional<ReplayQueues> queues;
};

/// A frame takes several events at once, and knows none before.
TEST(ReplayQueues, takes_no_second_event_of_a_base_mesh_until_the_frame_knows_of_the_first)
{
    using enum QueueEventKind;
    const std::string back = "model 0: cells are returned that were not lent";
    const std::string came = "model 0: its base mesh arrives without a request";
    EXPECT_EQ(WantedBase().open({base_back, base_back}), back);
    EXPECT_EQ(WantedBase().open({base_back, arrival}), came);
    EXPECT_EQ(WantedBase().open({arrival, base_back}), back);
    EXPECT_EQ(WantedBase().open({arrival, arrival}), came);
    EXPECT_EQ(WantedBase().open({arrival}), std::nullopt);
    WantedBase sut;
    EXPECT_EQ(sut.open({base_back}), std::nullopt);
    sut.run();
    ASSERT_EQ(sut.output.models[0].stage, ModelStage::known);
    EXPECT_EQ(sut.open({base_back}), back);
    for (int i = 0; i < 1'000 && sut.rig->frame().model({0}).stage == ModelStage::known; ++i)
    {
        sut.run();
    }
    ASSERT_EQ(sut.rig->frame().model({0}).stage, ModelStage::wanted);
    EXPECT_EQ(sut.open({arrival}), came); // The event does not confirm the freed cells.
    EXPECT_EQ(sut.open({arrival}, 1), std::nullopt);
    sut.run();
    EXPECT_GE(sut.output.models[0].stage, ModelStage::arriving);
}

TEST(BaseRoom, gives_the_lowest_gap_that_is_long_enough_and_refuses_where_none_is)
{
    BaseRoom sut(10);
    EXPECT_FALSE(sut.try_take(11).has_value());
    EXPECT_EQ(sut.try_take(4), 0U);
    EXPECT_EQ(sut.try_take(3), 4U);
    EXPECT_EQ(sut.try_take(3), 7U);
    EXPECT_FALSE(sut.try_take(1).has_value());
    sut.give_back(4);
    EXPECT_EQ(sut.used(), 7U);
    EXPECT_FALSE(sut.try_take(4).has_value());
    EXPECT_EQ(sut.try_take(1), 4U);
    EXPECT_EQ(sut.try_take(2), 5U);
    sut.give_back(0);
    sut.give_back(7);
    EXPECT_FALSE(sut.try_take(5).has_value());
    EXPECT_EQ(sut.try_take(4), 0U);
}

TEST(BaseRoom, has_one_range_a_model_and_no_more)
{
    BaseRoom sut(2 * kMaxModels);
    for (std::uint32_t i = 0; i < kMaxModels; ++i)
    {
        EXPECT_EQ(sut.try_take(1), i);
    }
    EXPECT_FALSE(sut.try_take(1).has_value());
    sut.give_back(17);
    EXPECT_EQ(sut.try_take(1), 17U);
}

TEST(PoolRoom, promises_all_or_nothing_and_takes_it_back)
{
    PoolRoom sut(10);
    PoolShare a;
    PoolShare b;
    EXPECT_FALSE(sut.try_promise(a, 11));
    EXPECT_TRUE(sut.try_promise(a, 7));
    EXPECT_FALSE(sut.try_promise(b, 4));
    EXPECT_EQ(sut.left_for(b), 3U);
    sut.take(a);
    sut.give_back(a);
    sut.end_promise(a);
    EXPECT_EQ(sut.left_for(b), 10U);
    EXPECT_TRUE(sut.try_promise(b, 10));
    EXPECT_EQ(sut.left_for(a), 0U);
}

} // namespace
} // namespace tactus::test
