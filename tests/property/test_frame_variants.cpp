// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Frames without one of their shortcuts, or with a tolerance: answers hold all the same (I5), and
/// what is exact is the same to the bit.

#include "tests/property/frame_checks.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <tuple>

namespace tactus::test
{
namespace
{

struct Named
{
    const char* name;
    FrameVariant variant;
};

constexpr std::array<Named, 9> kVariants{{
    {"no_rest", {.lets_pairs_rest = false}},
    {"cold_start", {.starts_warm = false}},
    {"forgotten_certificates", {.keeps_certificates = false}},
    {"refit_of_everything", {.refits_changed_only = false}},
    {"all_models_asked_for", {.asks_near_models_only = false}},
    {"searches_every_frame", {.keeps_searches = false}},
    {"no_prefetch", {.asks_ahead = false}},
    {"fixed_radius", {.fixed_radius = 1.5}},
    {"tolerance", {.tolerance_m = 1e-3}},
}};

class FrameVariants : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>>
{
protected:
    static constexpr int kFrames = 300;

    [[nodiscard]] RigOptions options() const
    {
        RigOptions options;
        options.tools = {{0.02 * model_.diagonal_m, 500.0, 8.0, 10.0}};
        options.tools[0].passes_through = true;
        options.faults.delay_polls_max = 20;
        return options;
    }
    /// Here and there, near the surface and away from it.
    Vec3 next_goal(const Vec3& goal, int frame)
    {
        if (frame % 100 == 0)
        {
            return place_at_distance(model_, random_, 0.01 * model_.diagonal_m);
        }
        return goal + random_.in_cube(0.001 * model_.diagonal_m);
    }

    const TestModel& model_ = small_model(std::get<0>(GetParam()));
    const Named& named_ = kVariants[std::get<1>(GetParam())];
    const std::uint64_t seed_ = seed_of(1'700 + std::get<0>(GetParam()));
    Random random_ = Random::seeded(seed_);
};

TEST_P(FrameVariants, answer_soundly_and_exactly_alike)
{
    SCOPED_TRACE(model_.name + " " + named_.name + " seed " + std::to_string(seed_));
    RigOptions changed = options();
    changed.variant = named_.variant;
    changed.variant.tolerance_m *= model_.diagonal_m;
    FrameRig usual(model_, options());
    FrameRig sut(model_, changed);
    Vec3 goal(0.0, 0.0, 0.0);
    int both_exact = 0;
    for (int frame = 0; frame < kFrames; ++frame)
    {
        goal = next_goal(goal, frame);
        const PairOutput expected = usual.step(goal).pairs[0];
        const PairOutput pair = sut.step(goal).pairs[0];
        const long double truth = brute_distance(pair.point_m, model_.faces);
        ASSERT_LE(static_cast<long double>(pair.lower_m), truth) << "frame " << frame;
        ASSERT_GE(static_cast<long double>(pair.upper_m), truth) << "frame " << frame;
        if (expected.kind == AnswerKind::exact && pair.kind == AnswerKind::exact)
        {
            ++both_exact;
            ASSERT_EQ(pair.lower_m, expected.lower_m) << "frame " << frame;
            ASSERT_EQ(pair.upper_m, expected.upper_m) << "frame " << frame;
            ASSERT_EQ(pair.nearest_face, expected.nearest_face) << "frame " << frame;
        }
    }
    if (named_.variant.tolerance_m == 0.0 && named_.variant.fixed_radius == 0.0)
    {
        EXPECT_GT(both_exact, kFrames / 4);
    }
}

std::string name_of(const testing::TestParamInfo<FrameVariants::ParamType>& info)
{
    std::string name =
        small_model(std::get<0>(info.param)).name + "_" + kVariants[std::get<1>(info.param)].name;
    std::ranges::replace_if(
        name, [](char letter) { return std::isalnum(static_cast<unsigned char>(letter)) == 0; },
        '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(SmallModels, FrameVariants,
                         testing::Combine(testing::Range(std::size_t{0}, kSmallModels),
                                          testing::Range(std::size_t{0}, kVariants.size())),
                         name_of);

TEST(FrameTolerance, splits_less_and_says_less)
{
    const TestModel& model = small_model(0);
    const double tolerance_m = 2e-3 * model.diagonal_m;
    const std::uint64_t seed = seed_of(1'790);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    RigOptions options;
    options.tools = {{0.02 * model.diagonal_m, 500.0, 8.0, 10.0}};
    options.tools[0].passes_through = true;
    RigOptions tolerant = options;
    tolerant.variant.tolerance_m = tolerance_m;
    for (int place = 0; place < 20; ++place)
    {
        FrameRig usual(model, options);
        FrameRig sut(model, tolerant);
        const Vec3 goal = place_at_distance(model, random, 0.01 * model.diagonal_m);
        usual.settle(goal, {}, 1'000);
        sut.settle(goal, {}, 1'000);
        const PairOutput pair = sut.step(goal).pairs[0];
        const long double truth = brute_distance(pair.point_m, model.faces);
        EXPECT_LE(static_cast<long double>(pair.lower_m), truth);
        EXPECT_GE(static_cast<long double>(pair.upper_m), truth);
        EXPECT_NE(pair.kind, AnswerKind::exact);
        EXPECT_LT(sut.model().forest.refined_records(), usual.model().forest.refined_records());
    }
}

TEST(FrameFixedRadius, splits_every_face_within_it)
{
    const TestModel& model = small_model(0);
    const double radius_m = 0.02 * model.diagonal_m;
    const std::uint64_t seed = seed_of(1'791);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    RigOptions options;
    options.tools = {{radius_m, 500.0, 8.0, 10.0}};
    options.tools[0].passes_through = true;
    std::uint32_t last = 0;
    const Vec3 goal = place_at_distance(model, random, 0.005 * model.diagonal_m);
    for (const double factor : {1.0, 2.0, 4.0})
    {
        options.variant.fixed_radius = factor;
        FrameRig sut(model, options);
        sut.settle(goal, {}, 2'000);
        const std::uint32_t refined = sut.model().forest.refined_records();
        EXPECT_GT(refined, last);
        last = refined;
    }
}

} // namespace
} // namespace tactus::test
