// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/pair_trial.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kFrames = 700;
/// Of the frames; odd against the swing's period.
constexpr std::size_t kStride = 31;
constexpr SceneSource kObject{"pair-object", nullptr, 0, 2'000};

/// Three faces a side, the last of each a twin of the first; at two places.
PairTruth small_truth()
{
    return {{{{0, 0}, {1, 1}}, {}}, {0.0, 0.5}, {0, 1, 0}, {0, 1, 0}};
}

TEST(JudgePairs, counts_what_is_planted)
{
    const PairTruth truth = small_truth();
    PairAnswers answers;
    answers.do_meet = {false, true};
    answers.meeting = {{{1, 1}, {1, 0}, {2, 2}, {0, 0}}, {{0, 1}}};
    answers.distances_m = {0.125, 0.25};

    const PairErrors any = judge_pairs(answers, truth, PairQuestion::any);
    const PairErrors all = judge_pairs(answers, truth, PairQuestion::all_pairs);
    const PairErrors distance = judge_pairs(answers, truth, PairQuestion::distance);

    EXPECT_EQ(any.missed, 1U);
    EXPECT_EQ(any.invented, 1U);
    EXPECT_EQ(all.missed, 0U); // The twins stand for the first faces.
    EXPECT_EQ(all.invented, 2U);
    EXPECT_EQ(distance.largest_m, 0.25);
    answers.meeting[0].clear();
    EXPECT_EQ(judge_pairs(answers, truth, PairQuestion::all_pairs).missed, 2U);
}

TEST(JudgePairs, a_distance_that_is_no_number_is_infinitely_wrong)
{
    PairAnswers answers;
    answers.distances_m = {std::numeric_limits<double>::quiet_NaN(), 0.5};
    EXPECT_EQ(judge_pairs(answers, small_truth(), PairQuestion::distance).largest_m,
              std::numeric_limits<double>::infinity());
}

/// Says what it is told to say; drifts when it is to.
class ScriptedPair final : public PairQuery
{
public:
    bool drifts{false};

    [[nodiscard]] std::string name() const override { return "script"; }
    void place(const Similarity& tool) override { x_m_ = tool.translation_m.x(); }
    [[nodiscard]] bool do_meet() override { return x_m_ > next(); }
    [[nodiscard]] const std::vector<test::FacePair>& meeting() override
    {
        pairs_.assign(1, {0, static_cast<std::uint32_t>(x_m_ + next())});
        return pairs_;
    }
    [[nodiscard]] double distance_m() override { return x_m_ + next(); }
    [[nodiscard]] test::FacePair in_source(const test::FacePair& own) const override
    {
        return {own.face, own.tool_face};
    }

private:
    double next() { return drifts ? ++asked_ : 0.0; }

    double x_m_{0.0};
    double asked_{0.0};
    std::vector<test::FacePair> pairs_;
};

TEST(ReplayPairs, asks_at_every_place_and_names_faces_as_the_sources_do)
{
    ScriptedPair sut;
    std::vector<Similarity> places(2);
    places[1].translation_m.x() = 7.0;

    const auto any = replay_pairs(sut, places, PairQuestion::any, 2);
    const auto all = replay_pairs(sut, places, PairQuestion::all_pairs, 2);
    const auto distance = replay_pairs(sut, places, PairQuestion::distance, 2);

    ASSERT_TRUE(any && all && distance);
    EXPECT_EQ(any.value().do_meet, (std::vector{false, true}));
    EXPECT_EQ(all.value().meeting[1], (std::vector{test::FacePair{7, 0}}));
    EXPECT_EQ(distance.value().distances_m, (std::vector{0.0, 7.0}));
}

TEST(ReplayPairs, refuses_passes_that_differ)
{
    ScriptedPair sut;
    sut.drifts = true;
    const std::vector<Similarity> places(3);
    EXPECT_TRUE(replay_pairs(sut, places, PairQuestion::distance, 1));
    EXPECT_FALSE(replay_pairs(sut, places, PairQuestion::distance, 2));
    EXPECT_FALSE(replay_pairs(sut, places, PairQuestion::all_pairs, 2));
}

/// A scene with a tool and some of its places.
class MeshTouch : public testing::Test
{
protected:
    void SetUp() override
    {
        const auto scene = scenes_.get(kObject);
        ASSERT_TRUE(scene);
        object = scene.value();
        const auto tool_scene = scenes_.get(make_tool_mesh(*object));
        ASSERT_TRUE(tool_scene);
        tool = tool_scene.value();
        meshes = {faces_in_source_frame(*tool), faces_in_model_frame(*object)};
        all_places = mesh_touch_motion(object->touch(), meshes.tool, kFrames);
        for (std::size_t i = 0; i < all_places.size(); i += kStride)
        {
            places.push_back(all_places[i]);
        }
    }

    const Scene* object{nullptr};
    const Scene* tool{nullptr};
    PairMeshes meshes;
    std::vector<Similarity> all_places;
    std::vector<Similarity> places;

private:
    SceneStore scenes_{""};
};

TEST_F(MeshTouch, the_tool_is_0_15_diagonals_across_and_turns_by_a_milliradian_a_frame)
{
    Vec3 low = meshes.tool[0][0];
    Vec3 high = low;
    for (const Triangle& triangle : meshes.tool)
    {
        for (const Vec3& corner : triangle)
        {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    }
    EXPECT_NEAR((high - low).maxCoeff() / object->model.diagonal_m, 0.15, 1e-4);
    for (std::size_t i = 1; i < all_places.size(); ++i)
    {
        const Mat3 turn = all_places[i].rotation * all_places[i - 1].rotation.transpose();
        ASSERT_NEAR(Eigen::AngleAxisd(turn).angle(), 1e-3, 1e-9);
    }
}

TEST_F(MeshTouch, the_tool_goes_through_the_surface_and_out_again)
{
    const PairTruth truth = find_pair_truth(*tool, *object, places);
    const double diagonal_m = object->model.diagonal_m;
    EXPECT_GT(truth.distances_m.front(), 0.001 * diagonal_m);
    const std::size_t lowest = 500 / kStride;
    EXPECT_GT(truth.meeting[lowest].size(), 4U);
    for (const double distance_m : truth.distances_m)
    {
        // Beside its nearest point the surface falls away a little.
        EXPECT_LE(distance_m, 0.006 * diagonal_m);
    }
}

void expect_right(PairQuery& query, const std::vector<Similarity>& places, const PairTruth& truth,
                  double tolerance_m)
{
    SCOPED_TRACE(query.name());
    for (const PairQuestion question : kPairQuestions)
    {
        SCOPED_TRACE(question_name(question));
        const auto answers = replay_pairs(query, places, question, 2);
        ASSERT_TRUE(answers) << answers.error().text;
        const PairErrors errors = judge_pairs(answers.value(), truth, question);
        EXPECT_EQ(errors.missed, 0U);
        EXPECT_EQ(errors.invented, 0U);
        EXPECT_LE(errors.largest_m, tolerance_m);
    }
}

TEST_F(MeshTouch, every_contestant_finds_what_the_oracle_finds)
{
    const PairTruth truth = find_pair_truth(*tool, *object, places);
    const double tolerance_m = 1e-9 * object->model.diagonal_m;
    const auto ours = TactusPairQuery::make(*tool, *object);
    ASSERT_TRUE(ours);
    expect_right(*ours.value(), places, truth, tolerance_m);
    for (const PairPeer& peer : pair_peers())
    {
        expect_right(*peer.make(meshes), places, truth, tolerance_m);
    }
}

} // namespace

} // namespace tactus::bench
