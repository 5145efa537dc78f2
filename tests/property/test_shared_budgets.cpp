// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Budgets are kept (I8) and count per model and frame: what one model uses up must not be missing
/// in another.

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
        std::array<ModelSource, 2> sources;
        for (std::size_t i = 0; i < 2; ++i)
        {
            served_[i] = serve_from_file(model.path, model.name, {}).value();
            const ModelHeader header = ModelHeader::parse(served_[i].header).value();
            sources[i] = {served_[i].header, served_[i].base,
                          plan_capacities(header, kBytes / 3, 0)};
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
        for (std::uint32_t i = 0; i < 2; ++i)
        {
            Model& parts = frame_->model({i});
            couriers_[i] =
                std::make_unique<Courier>(*arena_, parts.header, parts.slots, parts.linker,
                                          parts.inbox, *served_[i].link, model.name, Log{});
        }
    }

    FrameOutput step(const Vec3& goal_m, const Budgets& budgets)
    {
        for (int i = 0; i < 4; ++i)
        {
            now_ns_ += 250'000;
            couriers_[0]->step(now_ns_);
            couriers_[1]->step(now_ns_);
        }
        tools_[0].position_m = goal_m;
        return frame_->run(tools_, poses_, budgets, {});
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
    std::array<std::unique_ptr<Courier>, 2> couriers_;
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

} // namespace
} // namespace tactus::test
