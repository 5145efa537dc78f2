// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Mesh tools: bounds (I5), budgets (I8), meeting pairs and contacts under every hardship; exact
/// answers are those of the full meshes (I4).

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/worst_shapes.hpp"
#include "tests/stability/mesh_trial.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

namespace tactus::test
{

namespace
{

constexpr std::array<const char*, 7> kHardships{"usual",      "K-1",    "starved",    "small-pools",
                                                "lossy-link", "static", "little-work"};
constexpr std::array<double, 3> kScales{0.4, 2.0, 8.0};
constexpr std::array<double, 3> kSkins_diag{0.002, 0.0, 0.01}; ///< Skins in diagonals of the tool.

/// Models of 300 to 4,000 faces.
const TestModel& tool_model(std::size_t index)
{
    switch (index % 3)
    {
    case 0:
        return test_model("tool-gear", make_shape(Shape::gear, 600).value());
    case 1:
        return test_model("tool-torus", make_shape(Shape::torus, 300).value());
    default:
        return test_model("tool-bumpy", make_shape(Shape::bumpy_sphere, 4'000).value());
    }
}

void print(std::uint64_t seed, const MeshFigures& figures)
{
    std::printf(
        "seed %llu, exact %llu, meeting %llu, complete %llu, truncated %llu, %s\n",
        static_cast<unsigned long long>(seed), static_cast<unsigned long long>(figures.exact),
        static_cast<unsigned long long>(figures.meeting),
        static_cast<unsigned long long>(figures.complete),
        static_cast<unsigned long long>(figures.truncated), figures.truth.summary().c_str());
}

Hardship hardship_of(const TestModel& object, std::size_t index, std::size_t skin)
{
    Hardship hardship = hardship_named(object, kHardships[index]);
    hardship.radius_diag = kSkins_diag[skin % kSkins_diag.size()];
    return hardship;
}

class MeshTools : public testing::TestWithParam<std::size_t>
{
};

TEST_P(MeshTools, agree_with_all_faces_of_both_whatever_runs_out)
{
    constexpr std::uint32_t kFrames = 90;
    const TestModel& object = small_model(GetParam());
    const FaceTree tree(object.faces);
    for (std::size_t i = 0; i < kHardships.size(); ++i)
    {
        const std::uint64_t seed = seed_of(20'261'400 + 10 * GetParam() + i);
        const TestModel& tool = tool_model(GetParam() + i);
        const MeshFigures sut =
            run_mesh_trial({tool, object, tree, hardship_of(object, i, GetParam() + i / 2),
                            kScales[(GetParam() + i) % 3], seed, kFrames});
        print(seed, sut);
        EXPECT_TRUE(sut.truth.holds());
    }
}

INSTANTIATE_TEST_SUITE_P(small_models, MeshTools, testing::Range<std::size_t>(0, kSmallModels));

class KnownMeshTools : public testing::TestWithParam<KnownMesh>
{
};

TEST_P(KnownMeshTools, agree_with_all_faces_of_both_whatever_runs_out)
{
    const TestModel* object = known_model(GetParam());
    if (object == nullptr)
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    const FaceTree tree(object->faces);
    for (const std::size_t i : {0U, 1U, 2U, 3U, 4U, 6U}) // The static hardship is left out.
    {
        const std::uint64_t seed = seed_of(20'261'480 + i);
        const MeshFigures sut =
            run_mesh_trial({tool_model(i), *object, tree, hardship_of(*object, i, i),
                            0.5 / object->diagonal_m, seed, 100});
        print(seed, sut);
        EXPECT_TRUE(sut.truth.holds());
    }
}

INSTANTIATE_TEST_SUITE_P(meshes, KnownMeshTools, testing::Values(kKnownMeshes[3]),
                         [](const auto& mesh) { return std::string(mesh.param.name); });

class MeshToolSlides : public testing::TestWithParam<std::size_t>
{
};

TEST_P(MeshToolSlides, are_answered_and_reported_completely)
{
    const TestModel& object = small_model(GetParam());
    const FaceTree tree(object.faces);
    const std::uint64_t seed = seed_of(20'261'490 + GetParam());
    const MeshFigures sut =
        run_mesh_slide({tool_model(GetParam()), object, tree, hardship_of(object, 0, 0), 4.0, seed,
                        kMeshSettling + 300});
    print(seed, sut);
    std::printf("%s\n", sut.open.summary().c_str());
    EXPECT_TRUE(sut.truth.holds());
    EXPECT_TRUE(sut.open.holds());
    EXPECT_GT(sut.meeting, 20U);
}

// Smooth, round, open and sharp models.
INSTANTIATE_TEST_SUITE_P(small_models, MeshToolSlides, testing::Range<std::size_t>(0, 4));

TEST(CoincidentMeshes, share_faces_by_the_exact_decision_and_the_lowest_ids_are_kept)
{
    const TriangleMesh mesh = make_shape(Shape::sphere, 180).value();
    const TestModel& object = test_model("coincident-object", mesh, 100);
    const TestModel& tool = test_model("coincident-tool", mesh, 100);
    const FaceTree tree(object.faces);
    for (const std::size_t hardship : {0U, 5U})
    {
        const MeshFigures sut = run_coincident_meshes(
            {tool, object, tree, hardship_of(object, hardship, hardship), 1.0, 0, 24});
        print(0, sut);
        EXPECT_TRUE(sut.truth.holds());
        EXPECT_GT(sut.truncated, 6U);
    }
}

/// 1,000 faces each: about ten times as many pairs as a report holds.
TEST(CoincidentMeshes, of_many_faces_are_told_to_be_too_many_within_the_budgets)
{
    const TriangleMesh mesh = make_shape(Shape::bumpy_sphere, 1'000).value();
    const TestModel& object = test_model("overlapped-object", mesh);
    const TestModel& tool = test_model("overlapping-tool", mesh);
    const FaceTree tree(object.faces);
    for (const std::size_t hardship : {0U, 2U, 5U})
    {
        const MeshFigures sut = run_coincident_meshes(
            {tool, object, tree, hardship_of(object, hardship, 0), 1.0, 0, 24});
        print(0, sut);
        EXPECT_TRUE(sut.truth.holds());
        EXPECT_EQ(sut.meeting, 24U);
        EXPECT_TRUE(sut.truncated > 3U || hardship != 5U); // Required for fully resident models.
    }
}

/// Tools twenty times as large as the object, touching it and containing it.
TEST(MeasuringMeshTools, that_are_larger_than_the_object_agree_with_all_faces_of_both)
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        const TestModel& object = small_model(i);
        const FaceTree tree(object.faces);
        const std::uint64_t seed = seed_of(20'261'510 + i);
        const MeshFigures sut = run_mesh_trial(
            {tool_model(i), object, tree, hardship_of(object, 0, i),
             0.05 * tool_model(i).diagonal_m / object.diagonal_m, seed, kMeshSettling});
        print(seed, sut);
        EXPECT_TRUE(sut.truth.holds());
        EXPECT_GT(sut.meeting, 20U);
    }
}

TEST(MeasuringMeshTools, that_want_no_pairs_have_the_same_answers)
{
    std::uint64_t met = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const TestModel& object = small_model(i);
        const FaceTree tree(object.faces);
        const PairlessFigures sut =
            run_mesh_without_pairs({tool_model(i), object, tree, hardship_of(object, 0, i),
                                    kScales[i], seed_of(20'261'520 + i), 250});
        std::printf("%s\n", sut.same.summary().c_str());
        met += sut.met;
        EXPECT_TRUE(sut.same.holds());
    }
    EXPECT_GT(met, 50U);
}

TEST(MeshToolTwins, exact_answers_are_those_of_the_full_meshes_to_the_last_bit)
{
    std::uint64_t exact = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const TestModel& object = small_model(i);
        const FaceTree tree(object.faces);
        const TrialFigures sut =
            run_mesh_twin({tool_model(i), object, tree, hardship_of(object, 0, i), kScales[i],
                           seed_of(20'261'500 + i), 250});
        std::printf("%s\n", sut.summary().c_str());
        exact += sut.trials;
        EXPECT_TRUE(sut.holds());
    }
    EXPECT_GT(exact, 100U);
}

} // namespace

} // namespace tactus::test
