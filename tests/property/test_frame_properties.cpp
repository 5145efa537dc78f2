// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The frame's invariants: I4 a certified ball equals the full mesh, and that it gets there and
/// back. I5, I7 and I8, brackets and budgets under hardship, are in tests/stability.

#include "rt_core/query/surface_query.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace tactus::test
{
namespace
{

/// A random walk of the goal: slides, jumps, rests and trips away from the model.
class Walk
{
public:
    Walk(const TestModel& model, Random& random) : model_(model), random_(random) { jump(); }

    Vec3 next()
    {
        const double dice = random_.between(0.0, 1.0);
        if (dice < 0.01)
        {
            jump();
        }
        else if (dice < 0.05)
        {
            velocity_ = random_.in_cube(0.004 * model_.diagonal_m);
        }
        else if (dice < 0.07)
        {
            velocity_.setZero();
        }
        place_ += velocity_;
        return place_;
    }

private:
    /// Near a random corner of the source, or anywhere round the model.
    void jump()
    {
        const Face& face = model_.faces[random_.below(model_.faces.size())];
        const bool near = random_.between(0.0, 1.0) < 0.8;
        place_ = to_vec3(face[0]) + random_.in_cube((near ? 0.01 : 0.5) * model_.diagonal_m);
        velocity_ = random_.in_cube(0.001 * model_.diagonal_m);
    }

    const TestModel& model_;
    Random& random_;
    Vec3 place_{0.0, 0.0, 0.0};
    Vec3 velocity_{0.0, 0.0, 0.0};
};

class CertifiedBall : public testing::TestWithParam<std::size_t>
{
};

TEST_P(CertifiedBall, holds_the_same_faces_and_distances_as_the_full_mesh)
{
    const TestModel& model = small_model(GetParam());
    const std::uint64_t seed = seed_of(500 + GetParam());
    SCOPED_TRACE(model.name + " seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    FrameRig sut(model, {});
    OwnedSurface surface;
    int exact = 0;
    int answered = 0;
    for (int trial = 0; trial < 60; ++trial)
    {
        const Face& face = model.faces[random.below(model.faces.size())];
        const Vec3 place = to_vec3(face[1]) + random.in_cube(0.01 * model.diagonal_m);
        sut.settle(place, {}, 400);
        const double reach = random.between(0.008, 0.015) * model.diagonal_m;
        const FrameOutput output = sut.step(place);
        const Vec3 center = output.tools[0].proxy_m;
        WalkBudget budget{100'000, 1'000'000};
        QueryMemory memory;
        gather_surface(sut.model().tree, center, reach, memory, budget, surface);
        const double radius = surface.answer.certified_radius_m;
        std::set<Face> found;
        for (std::uint32_t i = 0; i < surface.count; ++i)
        {
            found.insert(surface.triangles[i].corners_m);
        }
        // A face at the very edge of the ball may fall on either side of it by rounding.
        const double slack = 1e-12 * model.diagonal_m;
        for (const Face& source : model.faces)
        {
            if (brute_distance(center, source) < static_cast<long double>(radius - slack))
            {
                Face turned = source;
                bool present = false;
                for (int turn = 0; turn < 3; ++turn)
                {
                    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
                    present = present || found.contains(turned);
                }
                ASSERT_TRUE(present) << "trial " << trial << ": a source face is missing";
            }
        }
        answered += surface.answer.kind == AnswerKind::decided ? 1 : 0;
        if (surface.answer.kind == AnswerKind::exact)
        {
            ++exact;
            ++answered;
            const auto truth = static_cast<double>(brute_distance(center, model.faces));
            EXPECT_NEAR(surface.answer.upper_m, truth, 1e-14) << "trial " << trial;
        }
    }
    EXPECT_GT(exact, 3) << "of 60 trials";
    EXPECT_GT(answered, 50) << "of 60 trials";
}

INSTANTIATE_TEST_SUITE_P(small_models, CertifiedBall, testing::Range<std::size_t>(0, 6));

TEST(FrameProgress, one_split_a_frame_reaches_exact_with_a_still_tool)
{
    const TestModel& model = small_model(0);
    FrameRig sut(model, {});
    load_everything(sut);
    Budgets one;
    one.splits = 1;
    one.merges = 1;
    const Vec3 place = to_vec3(model.faces[100][0]);
    int frames = 0;
    while (frames < 2'000 && sut.step(place, one).pairs[0].kind != AnswerKind::exact)
    {
        ++frames;
    }
    EXPECT_LT(frames, 400);
}

TEST(FrameProgress, leaving_returns_the_forest_to_its_base_state)
{
    const TestModel& model = small_model(1);
    FrameRig sut(model, {});
    const std::uint64_t base_hash = sut.model().forest.state_hash();
    const Vec3 far_away = to_vec3(model.faces[0][0]) + Vec3(0.0, 0.0, 5.0 * model.diagonal_m);
    sut.settle(far_away, {}, 20);
    // The proxy stops at surfaces in its way, so the goal goes round: up, across, down and back.
    const Vec3 touch = to_vec3(model.faces[50][0]);
    const Vec3 above = touch + Vec3(0.0, 0.0, 5.0 * model.diagonal_m);
    for (const Vec3& goal : {above, touch})
    {
        sut.settle(goal, {}, 400);
    }
    EXPECT_NE(sut.model().forest.state_hash(), base_hash);
    sut.settle(above, {}, 600);
    for (int i = 0; i < 600; ++i)
    {
        static_cast<void>(sut.step(above));
    }
    EXPECT_EQ(sut.model().forest.state_hash(), base_hash);
}

TEST(FrameRehearsal, changes_no_result)
{
    const TestModel& model = small_model(3);
    const std::uint64_t seed = seed_of(9'000);
    Random random = Random::seeded(seed);
    Random same = Random::seeded(seed);
    Walk motion(model, random);
    Walk same_motion(model, same);
    FrameRig plain(model, {});
    FrameRig rehearsed(model, {});
    for (int frame = 0; frame < 300; ++frame)
    {
        rehearsed.frame().rehearse();
        const FrameOutput a = plain.step(motion.next());
        const FrameOutput b = rehearsed.step(same_motion.next());
        ASSERT_EQ(a.models[0].state_hash, b.models[0].state_hash) << "frame " << frame;
        ASSERT_EQ(a.tools[0].force_n, b.tools[0].force_n) << "frame " << frame;
        ASSERT_EQ(a.pairs[0].lower_m, b.pairs[0].lower_m) << "frame " << frame;
    }
}

} // namespace
} // namespace tactus::test
