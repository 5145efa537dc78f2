// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A flood of arrivals keeps the budget (I8). Meshes and hardships at which a frame is at its
/// worst: tests/stability.

#include "tests/property/frame_checks.hpp"

namespace tactus::test
{
namespace
{

/// Everything that a ball needs comes at once, before the next frame looks.
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
    const auto waiting = static_cast<std::uint32_t>(sut.frame().pools().cache.door.arrived.size());
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
