// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I5: L <= d <= U in every frame under every hardship, with every budget kept (I7, I8). The checks
/// can fail: models with false bounds are detected.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/worst_shapes.hpp"
#include "tests/stability/bracket_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>

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

} // namespace tactus::test
