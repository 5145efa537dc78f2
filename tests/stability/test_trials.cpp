// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I5: L <= d <= U in every frame under every hardship, with every budget kept (I7, I8). The checks
/// can fail: models with false bounds are detected.
/// A device that sends garbage yields a safe force, and the frame's faults report it.
/// I2: nothing drifts; splits and merges, touches and rests return to the same state.

#include "host_tools/shapes/shapes.hpp"
#include "platform/choices/device_choice.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/trial_length.hpp"
#include "tests/shared/worst_shapes.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/day_trial.hpp"
#include "tests/stability/garbage_trial.hpp"
#include "tests/stability/rigid_trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <xmmintrin.h>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kBracketFrames = 150;
/// Share of answered frames without a hardship; jumps and moved objects cost some.
constexpr double kAnswered = 0.8;

void expect_sound_brackets(const TestModel& model, std::uint64_t own_seed, std::uint32_t frames)
{
    const CenterOracle oracle(model);
    std::uint64_t own = 20'261'200 + own_seed;
    for (const Hardship& hardship : hardships(model))
    {
        own += 100;
        const std::uint64_t seed = seed_of(own);
        const BracketFigures figures =
            run_bracket_trial({model, oracle.tree(), oracle, hardship, seed, frames});
        std::printf("seed %llu, %s\n", static_cast<unsigned long long>(seed),
                    figures.bounded.summary().c_str());
        EXPECT_TRUE(figures.bounded.holds());
        if (hardship.has_all)
        {
            EXPECT_GT(static_cast<double>(figures.answered), kAnswered * frames);
        }
    }
}

class Bracket : public testing::TestWithParam<std::size_t>
{
};

TEST_P(Bracket, holds_and_budgets_are_kept_whatever_runs_out)
{
    expect_sound_brackets(generated_model(GetParam()), GetParam(), kBracketFrames);
}

INSTANTIATE_TEST_SUITE_P(generated, Bracket,
                         testing::Range<std::size_t>(0, generated_model_count()));

class KnownBracket : public testing::TestWithParam<KnownMesh>
{
};

TEST_P(KnownBracket, holds_and_budgets_are_kept_whatever_runs_out)
{
    const TestModel* model = known_model(GetParam());
    if (model == nullptr)
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    expect_sound_brackets(*model, 50 + model->faces.size() % 50, kBracketFrames);
}

// The largest takes seconds to encode; it is in the extended run.
INSTANTIATE_TEST_SUITE_P(meshes, KnownBracket, testing::ValuesIn(kKnownMeshes, kKnownMeshes + 4),
                         [](const auto& mesh) { return std::string(mesh.param.name); });

/// The same motion over the same mesh, with scaled bounds.
TrialFigures bracket_with_bounds_times(double factor)
{
    const TriangleMesh mesh = make_shape(Shape::bumpy_sphere, 4'000).value();
    const TestModel& model = lying_model("bounds-" + std::to_string(factor), mesh, factor);
    const CenterOracle oracle(model);
    const Hardship hardship = hardship_named(model, "K-1");
    return run_bracket_trial({model, oracle.tree(), oracle, hardship, seed_of(20'261'290), 1'000})
        .bounded;
}

TEST(BracketsOfALiar, are_flagged_when_the_plain_coarse_distance_is_taken)
{
    EXPECT_TRUE(bracket_with_bounds_times(1.0).holds());
    const TrialFigures sut = bracket_with_bounds_times(0.0);
    EXPECT_GT(sut.violations, 10U);
    ASSERT_FALSE(sut.texts.empty());
    EXPECT_NE(sut.texts[0].find("TACTUS_SEED="), std::string::npos) << sut.texts[0];
    EXPECT_NE(sut.texts[0].find("face "), std::string::npos) << sut.texts[0];
}

TEST(BracketsOfALiar, are_flagged_at_the_worst_original_points_when_bounds_are_a_fifth_smaller)
{
    for (const Shape shape : {Shape::bumpy_sphere, Shape::torus, Shape::terrain})
    {
        const TriangleMesh mesh = make_shape(shape, 4'000).value();
        const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
        const TrialFigures honest = query_worst_points(lying_model(name + "-1", mesh, 1.0));
        const TrialFigures sut = query_worst_points(lying_model(name + "-0.8", mesh, 0.8));
        EXPECT_GT(honest.trials, 100U);
        EXPECT_EQ(honest.violations, 0U) << honest.summary();
        EXPECT_GT(sut.violations, 0U) << "of " << sut.trials << " points of " << name;
        std::printf("%s: of %llu worst points %llu flagged\n", name.c_str(),
                    static_cast<unsigned long long>(sut.trials),
                    static_cast<unsigned long long>(sut.violations));
    }
}

} // namespace

namespace
{

class DeviceGarbage : public testing::TestWithParam<std::size_t>
{
};

TEST_P(DeviceGarbage, gets_a_safe_force_and_is_told_of)
{
    const TestModel& model = small_model(0);
    const CenterOracle oracle(model);
    const TrialFigures sut = run_garbage_trial(model, oracle, garbage_kinds()[GetParam()], 4'000,
                                               seed_of(20'261'500 + GetParam()));
    std::printf("%s\n", sut.summary().c_str());
    EXPECT_TRUE(sut.holds());
}

INSTANTIATE_TEST_SUITE_P(kinds, DeviceGarbage, testing::Range<std::size_t>(0, kGarbageKinds));

TEST(DeviceGarbageOfABody, gets_a_safe_force_and_torque_and_is_told_of)
{
    for (const Garbage& garbage : rigid_garbage_kinds())
    {
        const TrialFigures sut = run_rigid_garbage_trial(garbage, 600, seed_of(20'261'540));
        EXPECT_TRUE(sut.holds()) << sut.summary();
    }
}

#if defined(__x86_64__)
/// A library built with -ffast-math may set both flags. The haptic thread resets and reports them,
/// and a frame that runs with them is still right.
TEST(FlushedDenormals, leave_brackets_true)
{
    const TestModel& model = small_model(0);
    const CenterOracle oracle(model);
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040U);
    const BracketFigures sut = run_bracket_trial(
        {model, oracle.tree(), oracle, hardship_named(model, "usual"), seed_of(20'261'520), 1'000});
    _mm_setcsr(before);
    EXPECT_TRUE(sut.bounded.holds()) << sut.bounded.summary();
}
#endif

} // namespace

namespace
{

/// Deviation of poses from orthonormal for which L and U hold (kPoseRounding).
constexpr double kOrthonormal = 2e-15;

/// Placement by `--place`, with a rotation vector in degrees.
Similarity place_turned(const Vec3& degrees)
{
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "0,0,0,%.17g,%.17g,%.17g", degrees.x(), degrees.y(),
                  degrees.z());
    return hrtc::parse_placement(text.data()).value();
}

TEST(Placement, rotations_of_any_angle_are_orthonormal_and_no_mirrors)
{
    Random random(600);
    double worst = 0.0;
    for (int i = 0; i < 20'000; ++i)
    {
        const double angle_deg = std::exp2(random.between(-60.0, 8.4)); // Angles up to 338 degrees.
        const Mat3 sut = place_turned(angle_deg * random.in_cube(1.0).normalized()).rotation;
        const Mat3 off = sut.transpose() * sut - Mat3::Identity();
        worst = std::max(worst, off.norm());
        ASSERT_NEAR(sut.determinant(), 1.0, kOrthonormal) << "rotation " << i;
    }
    std::printf("worst departure %g\n", worst);
    EXPECT_LE(worst, kOrthonormal);
}

} // namespace

namespace
{

TEST(LongRun, random_splits_and_merges_return_to_the_same_state)
{
    const TrialFigures sut = run_split_merge_trial(small_model(0), 200'000, seed_of(20'261'400));
    std::printf("%s\n", sut.summary().c_str());
    EXPECT_GE(sut.trials, 200'000U);
    EXPECT_TRUE(sut.holds());
}

TEST(LongRun, touches_return_to_the_same_rest_and_a_pressed_proxy_does_not_creep)
{
    const DayFigures sut = run_day_trial(small_model(0), 24, seed_of(20'261'410));
    std::printf("%s\n%s\n%.0f s simulated\n", sut.returns.summary().c_str(),
                sut.creep.summary().c_str(), sut.simulated_s);
    EXPECT_TRUE(sut.returns.holds());
    EXPECT_TRUE(sut.creep.holds());
}

} // namespace

namespace
{

RigidFigures try_all(std::vector<RigidTrial> trials, std::uint32_t frames, std::uint64_t first_seed)
{
    RigidFigures all;
    const std::size_t stride = has_full_trials() ? 1 : 2;
    for (std::size_t i = 0; i < trials.size(); i += stride)
    {
        RigidTrial& trial = trials[i];
        trial.seed = seed_of(first_seed) + i;
        trial.frames = frames;
        const RigidFigures figures = run_rigid_trial(trial);
        EXPECT_TRUE(figures.crossings.holds()) << figures.crossings.summary();
        EXPECT_TRUE(figures.steps.holds()) << figures.steps.summary();
        all.add(figures);
    }
    return all;
}

TEST(RigidTrial, pegs_plates_gears_and_needles_never_go_through)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::still), 400, 1);
    EXPECT_GT(all.contacts, trial_length(500));
    EXPECT_LT(all.halted, all.contacts);
}

TEST(RigidTrial, boxes_capsules_hulls_and_meshes_never_go_through_any_shape)
{
    const RigidFigures all = try_all(rigid_trials_on_small_models(), 400, 401);
    EXPECT_GT(all.contacts, trial_length(1'500));
    EXPECT_EQ(all.over_constrained, 0U);
}

TEST(RigidTrial, nor_through_objects_that_turn)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::turning), 200, 101);
    EXPECT_GT(all.contacts, trial_length(200));
    EXPECT_EQ(all.run_over, 0U);
    EXPECT_EQ(all.over_constrained, 0U);
}

TEST(RigidTrial, nor_through_what_stands_far_away_turned_and_of_another_size)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::far), 200, 201);
    EXPECT_GT(all.contacts, trial_length(200));
    EXPECT_EQ(all.over_constrained, 0U);
}

TEST(RigidTrial, between_objects_that_close_in_are_run_over_only_where_they_say_so)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::closing), 600, 301);
    EXPECT_GT(all.contacts, trial_length(2'000));
    EXPECT_GT(all.run_over, trial_length(100)); // Shows that cases occurred.
    EXPECT_GT(all.over_constrained, trial_length(100));
    EXPECT_GT(all.steps.trials, trial_length(50));
}

} // namespace

} // namespace tactus::test
