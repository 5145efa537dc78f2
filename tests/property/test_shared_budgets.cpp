// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Budgets are kept (I8) and are the frame's: what one model uses up is not missing in another for
/// long. So are pools: what one model brought another may use, but for what is kept for it.

#include "tests/property/frame_checks.hpp"

#include <array>
#include <memory>
#include <optional>

namespace tactus::test
{
namespace
{

/// One frame over two copies of a model, each an object of its own, and one tool.
class TwoModels
{
public:
    explicit TwoModels(const TestModel& model) : memory_(kBytes + Arena::kAlignment)
    {
        const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
        const std::size_t skip = (Arena::kAlignment - address % Arena::kAlignment) % 64;
        arena_.emplace(std::span(memory_).subspan(skip, kBytes));
        std::vector<ModelHeader> headers;
        for (ServedModel& served : served_)
        {
            served = serve_from_file(model.path, model.name, {}).value();
            headers.push_back(ModelHeader::parse(served.header).value());
        }
        std::array<ModelCapacities, 2> capacities;
        EXPECT_TRUE(try_plan(headers, kBytes / 3 * 2, 0, capacities));
        std::array<ModelSource, 2> sources;
        for (std::size_t i = 0; i < 2; ++i)
        {
            sources[i] = {served_[i].header, served_[i].base, capacities[i]};
        }
        const std::array<ToolSpec, 1> tools{{{0.03 * model.diagonal_m, 500.0, 8.0, 1.0}}};
        const std::array<ObjectSpec, 2> objects{{{ModelId{0}}, {ModelId{1}}}};
        FrameSetup setup;
        setup.models = sources;
        setup.objects = objects;
        setup.tools = tools;
        EXPECT_TRUE(Frame::start(frame_, *arena_, setup));
        origin_m_ = frame_->model({0}).header.origin_m();
        for (ObjectPose& pose : poses_)
        {
            pose.translation_m = -origin_m_; // Goals are of the model's frame.
        }
        courier_.emplace(*arena_, frame_->pools().slots, frame_->pools().cache.door, Log{});
        for (std::uint32_t i = 0; i < 2; ++i)
        {
            Model& parts = frame_->model({i});
            courier_->add(parts.header, parts.linker, *served_[i].link, model.name);
        }
    }

    FrameOutput step(const Vec3& goal_m, const Budgets& budgets)
    {
        for (int i = 0; i < 4; ++i)
        {
            now_ns_ += 250'000;
            courier_->step(now_ns_);
        }
        tools_[0].position_m = goal_m;
        std::array<SceneChange, 2> moves;
        for (std::uint32_t i = 0; i < 2; ++i)
        {
            moves[i].number = i;
            moves[i].pose = poses_[i];
        }
        return frame_->run({tools_, moves, budgets});
    }
    void move_away(std::size_t object, double distance_m)
    {
        poses_[object].translation_m.z() = distance_m - origin_m_.z();
    }
    [[nodiscard]] std::uint32_t refined(std::uint32_t model) const
    {
        return frame_->model({model}).forest.refined_records();
    }

private:
    static constexpr std::size_t kBytes = std::size_t{24} << 20U;

    std::vector<std::byte> memory_;
    std::optional<Arena> arena_;
    std::array<ServedModel, 2> served_;
    std::optional<Frame> frame_;
    std::optional<Courier> courier_;
    std::int64_t now_ns_{0};
    std::array<ToolState, 1> tools_;
    Vec3 origin_m_{0.0, 0.0, 0.0};
    std::array<ObjectPose, 2> poses_;
};

/// To and fro along a line beside the surface, far enough that records are split and left behind.
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
    TwoModels sut(model);
    const Vec3 place = place_at_distance(model, random, 0.0306 * model.diagonal_m);
    Budgets one;
    one.splits = 1;
    std::uint32_t refined_min = 0;
    for (int frame = 0; frame < 400; ++frame)
    {
        static_cast<void>(sut.step(swinging(model, place, frame), one));
        refined_min = std::max(refined_min, std::min(sut.refined(0), sut.refined(1)));
    }
    EXPECT_GT(refined_min, 5U) << "one of the models was left coarse throughout";
}

TEST(SharedBudgets, a_model_that_was_left_coarsens_while_another_is_scanned)
{
    const TestModel& model = small_model(0);
    for (std::size_t left = 0; left < 2; ++left)
    {
        Random random = Random::seeded(seed_of(801));
        TwoModels sut(model);
        const Vec3 place = place_at_distance(model, random, 0.0306 * model.diagonal_m);
        Budgets few;
        few.scanned = 8;
        for (int frame = 0; frame < 320; ++frame)
        {
            static_cast<void>(sut.step(swinging(model, place, frame), few));
        }
        const auto which = static_cast<std::uint32_t>(left);
        ASSERT_GT(sut.refined(which), 20U);
        sut.move_away(left, 20.0 * model.diagonal_m);
        for (int frame = 0; frame < 2'000 && sut.refined(which) > 0; ++frame)
        {
            static_cast<void>(sut.step(swinging(model, place, frame), few));
        }
        EXPECT_EQ(sut.refined(which), 0U) << "model " << left;
    }
}

TEST(SharedPools, a_touch_uses_faces_that_another_model_brought_and_that_keeps_its_part)
{
    const TestModel& model = small_model(0);
    RigOptions options;
    options.pool_bytes = std::size_t{1'200} << 10U;
    options.cache_bytes = std::size_t{600} << 10U;
    options.objects = {{ModelId{0}}, {ModelId{1}}};
    options.tools = {{0.3 * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.tools[0].passes_through = true;
    FrameRig rig({&model, &model}, options);
    const Vec3 place = to_vec3(model.faces[0][0]);
    ObjectPose away;
    away.translation_m = Vec3(0.0, 0.0, 20.0 * model.diagonal_m);
    std::array<std::uint32_t, 2> most{};
    for (std::size_t touched = 0; touched < 2; ++touched)
    {
        rig.place_object({}, touched);
        rig.place_object(away, 1 - touched);
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
    options.tools[0].passes_through = true;
    FrameRig rig({&model, &model}, options);
    const Vec3 place = to_vec3(model.faces[0][0]);
    ObjectPose away;
    away.translation_m = Vec3(0.0, 0.0, 20.0 * model.diagonal_m);
    const std::uint32_t brought = rig.model({0}).capacities.pages;
    ASSERT_EQ(brought, 8U);
    std::array<std::uint32_t, 2> used{};
    for (std::size_t turn = 0; turn < 4; ++turn)
    {
        const std::size_t touched = turn % 2;
        rig.place_object({}, touched);
        rig.place_object(away, 1 - touched);
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
