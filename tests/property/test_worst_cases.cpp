// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Meshes and hardships at which a frame is at its worst. Each stays within all its budgets, keeps
/// L <= d <= U, and says what ran out.

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/worst_shapes.hpp"

#include <functional>
#include <string>

namespace tactus::test
{
namespace
{

struct WorstShape
{
    const char* name;
    std::function<TriangleMesh()> make;
    std::uint32_t base_faces{200}; ///< More where pieces can't vanish.
};

const std::vector<WorstShape>& worst_shapes()
{
    static const std::vector<WorstShape> shapes{
        {"needles", [] { return make_uv_sphere(20, 400).value(); }},
        {"poles-300", [] { return make_uv_sphere(8, 300).value(); }},
        {"poles-4000", [] { return make_uv_sphere(2, 4'000).value(); }},
        {"spikes", [] { return make_spiky_sphere(); }},
        {"thin-plate-1e-4", [] { return make_thin_plate(30, 1.4e-5).value(); }},
        {"close-sheets", [] { return make_close_sheets(24); }},
        {"huge-and-tiny", [] { return make_patch_in_huge_faces(48); }},
        {"border", [] { return make_shape(Shape::terrain, 4'000).value(); }},
        {"broken", [] { return make_broken_sphere(); }},
        {"soup", [] { return make_triangle_soup(700, 5).value(); }, 700},
        {"components", [] { return make_loose_spheres(5); }, 1'500},
    };
    return shapes;
}

const TestModel& worst_model(std::size_t index)
{
    const WorstShape& shape = worst_shapes()[index];
    return test_model(std::string("worst-") + shape.name, shape.make(), shape.base_faces);
}

enum class Hardship : std::size_t
{
    none,
    one_split,        ///< K = 1, both ways.
    starved,          ///< Every budget near its least.
    few_pages,        ///< Every page is soon pinned.
    all_in_the_probe, ///< A tool larger than the model, and pools that hold a part of it.
    count,
};

Budgets budgets_of(Hardship hardship)
{
    Budgets budgets;
    if (hardship == Hardship::one_split)
    {
        budgets.splits = 1;
        budgets.merges = 1;
    }
    if (hardship == Hardship::starved)
    {
        budgets = Budgets{2, 2, 4, 6, 40, 1, 1, 1};
    }
    return budgets;
}

RigOptions options_of(Hardship hardship, const TestModel& model)
{
    RigOptions options;
    options.pool_bytes = std::size_t{12} << 20U;
    if (hardship == Hardship::few_pages)
    {
        options.cache_bytes = 5 * sizeof(Page);
    }
    if (hardship == Hardship::all_in_the_probe)
    {
        options.cache_bytes = 12 * sizeof(Page);
        options.tools = {{2.0 * model.diagonal_m, 500.0, 8.0, 1.0}};
    }
    return options;
}

/// Rests, slides of up to 0.5 % of the diagonal a frame, and a teleport every 20 frames.
Vec3 next_goal(const TestModel& model, Random& random, int frame, const Vec3& goal)
{
    if (frame % 20 != 0)
    {
        return frame % 40 < 10 ? goal : goal + random.in_cube(0.003 * model.diagonal_m);
    }
    const Face& face = model.faces[random.below(model.faces.size())];
    const double off = frame % 100 == 80 ? 1.0 : 0.01;
    return to_vec3(face[random.below(3)]) + random.in_cube(off * model.diagonal_m);
}

using Case = std::tuple<std::size_t, std::size_t>;

class WorstCases : public testing::TestWithParam<Case>
{
};

TEST_P(WorstCases, keep_the_budgets_and_the_bracket_and_say_what_ran_out)
{
    const TestModel& model = worst_model(std::get<0>(GetParam()));
    const auto hardship = static_cast<Hardship>(std::get<1>(GetParam()));
    const std::uint64_t seed =
        seed_of(900 + 10 * std::get<0>(GetParam()) + std::get<1>(GetParam()));
    SCOPED_TRACE(model.name + " seed " + std::to_string(seed));
    Random random(seed);
    const Budgets budgets = budgets_of(hardship);
    FrameRig sut(model, options_of(hardship, model));
    Vec3 goal(0.0, 0.0, 0.0);
    FrameFault seen = FrameFault::none;
    for (int frame = 0; frame < 200; ++frame)
    {
        goal = next_goal(model, random, frame, goal);
        const FrameOutput output = sut.step(goal, budgets);
        expect_all_budgets_kept(output, budgets);
        ASSERT_TRUE(answer_is_sound(model, output)) << "frame " << frame;
        ASSERT_FALSE(has_fault(output.faults, FrameFault::model_inconsistent)) << "frame " << frame;
        seen |= output.faults;
    }
    if (hardship == Hardship::all_in_the_probe && sut.model().header.counts().chunks() > 12)
    {
        EXPECT_TRUE(has_fault(seen, FrameFault::cache_full));
    }
    if (hardship == Hardship::starved)
    {
        EXPECT_TRUE(has_fault(seen, FrameFault::node_budget_spent));
    }
}

INSTANTIATE_TEST_SUITE_P(
    shapes, WorstCases,
    testing::Combine(testing::Range<std::size_t>(0, worst_shapes().size()),
                     testing::Range<std::size_t>(0, static_cast<std::size_t>(Hardship::count))));

/// Everything that a ball needs comes at once, before the next frame looks.
TEST(WorstCases, a_full_inbox_is_adopted_a_few_pages_a_frame)
{
    const TestModel& model = *small_models()[0];
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
    const auto waiting = static_cast<std::uint32_t>(sut.model().inbox.arrived.size());
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

} // namespace
} // namespace tactus::test
