// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"

#include <cmath>

namespace tactus::test
{
namespace
{

/// 152,000 faces up to 100 times as long as wide, and two poles of valence 4,000.
TEST(WorstCasesLarge, needles_keep_the_budgets_and_the_bracket)
{
    const TestModel& model = test_model("needles-20x4000", make_uv_sphere(20, 4'000).value());
    const std::uint64_t seed = seed_of(990);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    Budgets one;
    one.splits = 1;
    one.merges = 1;
    for (const Budgets& budgets : {Budgets{}, one})
    {
        FrameRig sut(model, {});
        Vec3 goal(0.0, 0.0, 0.0);
        for (int frame = 0; frame < 240; ++frame)
        {
            if (frame % 30 == 0) // A teleport, at times to a pole.
            {
                goal =
                    to_vec3(model.faces[random.below(model.faces.size())][frame % 60 == 0 ? 0 : 2]);
            }
            goal += random.in_cube(0.001 * model.diagonal_m);
            const FrameOutput output = sut.step(goal, budgets);
            expect_all_budgets_kept(output, budgets);
            ASSERT_TRUE(answer_is_sound(model, output)) << "frame " << frame;
        }
    }
}

} // namespace
} // namespace tactus::test
