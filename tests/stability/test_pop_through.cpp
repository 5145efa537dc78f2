// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The path of the proxy relative to an object crosses no face of the full mesh: fast taps, thin
/// plates, sharp and concave edges, moving objects, late or lost data; also with force shading. If
/// objects leave no space, the frame reports it. The checks can fail.

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/worst_shapes.hpp"
#include "tests/stability/pop_through_trial.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kPopFrames = 100;

const TestModel& notched_cube()
{
    return test_model("notched-cube", make_notched_cube(12));
}

void expect_no_crossing(const TestModel& model, std::uint64_t own_seed)
{
    const FaceTree tree(model.faces);
    std::uint64_t own = 20'261'700 + own_seed;
    for (const bool is_smooth : {false, true})
    {
        std::uint64_t in_contact = 0;
        std::uint64_t felt_shaded = 0;
        for (const Hardship& hardship : hardships(model))
        {
            own += 100;
            const PopThroughFigures sut =
                run_pop_through_trial({model, tree, hardship, seed_of(own), kPopFrames, is_smooth});
            EXPECT_TRUE(sut.crossings.holds()) << sut.crossings.summary();
            EXPECT_TRUE(sut.run_over.holds()) << sut.run_over.summary();
            in_contact += sut.in_contact;
            felt_shaded += sut.felt_shaded;
        }
        EXPECT_GT(in_contact, 20U);
        EXPECT_EQ(felt_shaded > 0, is_smooth);
    }
}

class PopThrough : public testing::TestWithParam<std::size_t>
{
};

TEST_P(PopThrough, never_happens_unless_an_object_runs_over_the_tool_and_it_is_told)
{
    expect_no_crossing(generated_model(GetParam()), GetParam());
}

// Bumpy, open, sharp, thin, needles, crumbs; spikes, plates and sheets 1e-4 diag apart, borders,
// fins, loose pieces. The extended run has all.
INSTANTIATE_TEST_SUITE_P(generated, PopThrough,
                         testing::Values(0, 2, 3, 4, 5, 6, 10, 11, 12, 14, 15, 17));

TEST(PopThroughCorners, never_happens_at_sharp_and_concave_ones)
{
    expect_no_crossing(notched_cube(), 99);
}

TEST(PopThroughClosing, objects_that_leave_no_room_are_told_and_the_force_fades)
{
    const TestModel& model = notched_cube();
    const FaceTree tree(model.faces);

    for (const bool is_smooth : {false, true})
    {
        SCOPED_TRACE(is_smooth ? "force shading" : "no force shading");
        const PopThroughFigures sut =
            run_closing_trial({model, tree, seed_of(20'261'790), 40, is_smooth});

        std::printf("%s\n", sut.crossings.summary().c_str());
        EXPECT_TRUE(sut.crossings.holds()) << sut.crossings.summary();
        EXPECT_GT(sut.over_constrained, 200U);
        EXPECT_GT(sut.faded, 100U);
        EXPECT_GE(sut.let_go, 39U) << "of 40";
        EXPECT_EQ(sut.felt_shaded > 0, is_smooth);
    }
}

/// Controller that starts while a hand leans into a model, as deep as three radii, and moves on.
/// The sphere is deep in hundreds of faces when the first of them are loaded.
struct LeaningStart
{
    const TestModel& model;
    std::uint32_t planes; ///< Planes of a frame's budget.
    std::uint64_t seed;
    bool is_smooth;
    std::uint32_t cut_short{0}; ///< Frames that were cut short.
    std::uint32_t in_contact{0};

    void run(const FaceTree& tree)
    {
        Random random = Random::seeded(seed);
        const double radius_m = random.between(0.005, 0.06) * model.diagonal_m;
        RigOptions options;
        options.tools = {{radius_m, 500.0, 8.0, 60.0 * model.diagonal_m}};
        options.tools[0].shading_m = is_smooth ? random.between(0.5, 5.0) * radius_m : 0.0;
        options.objects = {{ModelId{0}, {500.0, 0.4, 0.3}}};
        options.static_when_it_fits = random.one_in(2);
        FrameRig rig(model, options);
        const Face& face = model.faces[random.below(model.faces.size())];
        const Vec3 at_m = to_vec3(face[0]);
        const Vec3 way = random.in_cube(1.0);
        const Vec3 inward = random.in_cube(1.0).normalized();
        const Vec3 in = inward * (radius_m * random.between(0.0, 3.0));
        Budgets budgets;
        budgets.planes = planes;
        ProxyTrail trail(model, tree);
        for (std::uint32_t frame = 0; frame < 80; ++frame)
        {
            // The hand moves to the other side of the surface and back.
            const double turn = 0.05 * frame;
            const Vec3 goal_m = at_m + std::cos(turn) * in + (1e-3 * turn * radius_m) * way;
            const FrameOutput output = rig.step({goal_m}, budgets);
            const ToolOutput& tool = output.tools[0];
            const auto crossed = trail.follow(rig.frame().tool(0).path_m(), rig.pose(0));
            ASSERT_FALSE(crossed.moved) << crossed.moved->text() << ", frame " << frame;
            ASSERT_LE(output.work.planes_looked_at, budgets.planes);
            ASSERT_LE(tool.force_n.norm(), 8.0 * (1.0 + 1e-12));
            ASSERT_EQ(has_fault(output.faults, FrameFault::plane_budget_spent), tool.cut_short);
            ASSERT_TRUE(tool.under_way || !tool.cut_short);
            cut_short += tool.cut_short ? 1 : 0;
            in_contact += tool.in_contact ? 1 : 0;
        }
    }
};

TEST(PopThroughLeaning, never_happens_at_a_start_within_a_surface_whatever_may_be_looked_at)
{
    std::vector<const TestModel*> models{&worst_model(0), &worst_model(3), &small_model(0)};
    for (const std::size_t known : {std::size_t{0}, std::size_t{3}}) // Cow and bunny.
    {
        if (const TestModel* model = known_model(kKnownMeshes[known]); model != nullptr)
        {
            models.push_back(model);
        }
    }
    std::uint32_t cut_short = 0;
    std::uint32_t in_contact = 0;
    std::uint64_t own = 20'261'900;
    for (const TestModel* model : models)
    {
        const FaceTree tree(model->faces);
        for (const std::uint32_t planes : {2U, 40U, Budgets{}.planes})
        {
            for (int start = 0; start < 6; ++start)
            {
                LeaningStart sut{*model, planes, seed_of(++own), start % 2 == 1};
                sut.run(tree);
                ASSERT_FALSE(testing::Test::HasFatalFailure())
                    << model->name << ", TACTUS_SEED=" << sut.seed << ", planes " << planes
                    << (sut.is_smooth ? ", smooth" : "");
                cut_short += sut.cut_short;
                in_contact += sut.in_contact;
            }
        }
    }
    EXPECT_GT(cut_short, 20U);
    EXPECT_GT(in_contact, 200U);
}

/// Two faces in z = 0 that form the unit square.
struct Square
{
    TestModel model{"square",
                    {},
                    {{Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}},
                     {Vec3f{0, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}}},
                    1.5};
    FaceTree tree{model.faces};

    [[nodiscard]] bool is_met(const Vec3& from, const Vec3& to) const
    {
        return find_crossing(model, tree, from, to).has_value();
    }
};

TEST(ProxyTrail, meets_faces_edges_and_corners_also_when_it_only_touches)
{
    const Square sut;
    const double least = 0x1p-1074;
    EXPECT_TRUE(sut.is_met(Vec3(0.5, 0.25, 1.0), Vec3(0.5, 0.25, -1.0))); // Through a face.
    EXPECT_TRUE(sut.is_met(Vec3(0.5, 0.5, 1.0), Vec3(0.5, 0.5, -1.0))); // Through the common edge.
    // Through the common edge, oblique.
    EXPECT_TRUE(sut.is_met(Vec3(0.25, 0.75, 0.5), Vec3(0.75, 0.25, -0.5)));
    EXPECT_TRUE(sut.is_met(Vec3(1.0, 0.25, 1.0), Vec3(1.0, 0.25, -1.0))); // Through the border.
    EXPECT_TRUE(sut.is_met(Vec3(1.0, 1.0, 1.0), Vec3(1.0, 1.0, -1.0)));   // Through a corner.
    EXPECT_TRUE(sut.is_met(Vec3(0.3, 0.1, 1.0), Vec3(0.3, 0.1, 0.0)));    // Ends on the face.
    EXPECT_TRUE(
        sut.is_met(Vec3(-0.5, 0.5, 0.0), Vec3(0.5, 0.5, 0.0))); // Path in the plane of the face.
    // Through a corner, in the plane.
    EXPECT_TRUE(sut.is_met(Vec3(-1.0, 1.0, 0.0), Vec3(1.0, -1.0, 0.0)));

    EXPECT_FALSE(sut.is_met(Vec3(0.3, 0.1, 1.0), Vec3(0.3, 0.1, least)));
    EXPECT_FALSE(sut.is_met(Vec3(-least, 0.5, 1.0), Vec3(-least, 0.5, -1.0)));
    EXPECT_FALSE(sut.is_met(Vec3(0.5, 0.5, 1e-300), Vec3(9.0, 0.5, 1e-300)));
    EXPECT_FALSE(sut.is_met(Vec3(-1.0, 1.0 - 0x1p-53, 0.0), Vec3(1.0 - 0x1p-53, -1.0, 0.0)));
}

TEST(ProxyTrail, tells_its_own_steps_from_an_object_that_moves)
{
    const Square square;
    ProxyTrail sut(square.model, square.tree);
    ObjectPose pose;
    const std::array above{Vec3(0.5, 0.3, 0.5), Vec3(0.6, 0.3, 0.2)};
    const std::array through{Vec3(0.6, 0.3, 0.2), Vec3(0.6, 0.3, -0.2), Vec3(0.6, 0.3, -0.3)};
    EXPECT_FALSE(sut.follow(above, pose).moved);
    const ProxyTrail::Crossings own = sut.follow(through, pose);
    EXPECT_FALSE(own.carried);
    ASSERT_TRUE(own.moved);
    EXPECT_EQ(own.moved->from_m, through[0]);
    EXPECT_EQ(own.moved->face, 0U);

    const std::array stays{Vec3(0.6, 0.3, -0.3)};
    EXPECT_FALSE(sut.follow(stays, pose).carried);
    pose.translation_m = Vec3(0.0, 0.0, -0.4);
    const ProxyTrail::Crossings other = sut.follow(stays, pose);
    EXPECT_TRUE(other.carried);
    EXPECT_FALSE(other.moved);
    // Both move equally: nothing is crossed.
    pose.translation_m.z() -= 5.0;
    const std::array along{Vec3(0.6, 0.3, -5.3)};
    EXPECT_FALSE(sut.follow(along, pose).carried);
}

} // namespace

} // namespace tactus::test
