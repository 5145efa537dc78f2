// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Effects of single edits: what a pressed tool feels, when answers are exact, and that refused
/// edits and unused room change nothing.

#include "host_tools/shapes/shapes.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "tests/property/edited_soup.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/safe_force.hpp"
#include "tests/shared/trial_length.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/random_motion.hpp"
#include "tests/stability/trial_terms.hpp"
#include "tests/stability/whole_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kEditRoom = 4'000;

const TestModel& editable_plate()
{
    return test_model("effects-plate", make_shape(Shape::plate, 8'000).value());
}

RigOptions editable_options(double radius_m)
{
    RigOptions options = with_room_for_all();
    options.edit_faces = kEditRoom;
    options.tools = {{radius_m, 500.0, 8.0, 1.0}};
    return options;
}

/// Difference of two frames' results, without that of refused edits and work; empty if none.
std::string difference_of(const FrameOutput& a, const FrameOutput& b)
{
    if (!std::ranges::equal(a.tools, b.tools))
    {
        return "tools";
    }
    const auto is_same_pair = [](const PairOutput& x, const PairOutput& y)
    {
        return x.kind == y.kind && x.nearest_face == y.nearest_face && x.is_joined == y.is_joined &&
               x.skipped == y.skipped && x.is_shed == y.is_shed &&
               same_bits(x.lower_m, y.lower_m) && same_bits(x.upper_m, y.upper_m) &&
               same_bits(x.certified_radius_m, y.certified_radius_m) &&
               same_bits(x.point_m, y.point_m) && same_bits(x.nearest_point_m, y.nearest_point_m);
    };
    if (!std::ranges::equal(a.pairs, b.pairs, is_same_pair))
    {
        return "pairs";
    }
    const auto is_same_model = [](const ModelOutput& x, const ModelOutput& y)
    {
        return x.state_hash == y.state_hash && x.refined_records == y.refined_records &&
               x.edit_revision == y.edit_revision && x.added.used == y.added.used &&
               x.faces.used == y.faces.used && x.pages.used == y.pages.used &&
               x.is_static == y.is_static;
    };
    if (!std::ranges::equal(a.models, b.models, is_same_model))
    {
        return "models";
    }
    return a.faults == b.faults ? "" : "faults";
}

/// Sphere that is pressed into the top of a plate, in its middle, by 1 mm.
class PressedPlate
{
public:
    explicit PressedPlate(double force_tolerance_n = 0.0)
    {
        RigOptions options = editable_options(kRadius_m);
        options.force_tolerance_n = force_tolerance_n;
        rig_.emplace(model_, options);
        force_.emplace(ToolSpec{kRadius_m, 500.0, 8.0, 1.0}, 1e-3);
        const FaceTree tree(model_.faces);
        top_m = 0.5 * (tree.low_m() + tree.high_m());
        top_m.z() = tree.high_m().z();
    }

    ToolOutput step(double height_m)
    {
        const Vec3 goal_m = top_m + Vec3(0.0, 0.0, height_m);
        output = rig_->step(goal_m);
        const Vec3 before_n = sent_n;
        sent_n = force_->step(output.tools[0], goal_m);
        step_n = (sent_n - before_n).norm();
        return output.tools[0];
    }
    void press()
    {
        for (int i = 0; i < 400; ++i)
        {
            step(std::max(0.02 - 0.0001 * i, kPressed_m));
        }
        ASSERT_GT(sent_n.norm(), 0.3);
    }
    void send(const OwnedEdit& edit)
    {
        rig_->edit(edit.view());
        soup.apply(edit);
    }
    /// Adds faces equal to these source faces.
    void add_equals(OwnedEdit& edit, const std::vector<std::uint32_t>& faces)
    {
        for (const std::uint32_t face : faces)
        {
            const SourceFace& source = soup.source().faces[face];
            ASSERT_TRUE(author.add(edit, source.corners, source.bucket));
        }
    }
    /// Top faces with their middle within a distance of the tool's place.
    [[nodiscard]] std::vector<std::uint32_t> top_faces(double within_m) const
    {
        std::vector<std::uint32_t> faces;
        const std::vector<SourceFace>& all = soup.source().faces;
        for (std::uint32_t i = 0; i < all.size(); ++i)
        {
            const Face& face = all[i].corners;
            const Vec3 middle = (to_vec3(face[0]) + to_vec3(face[1]) + to_vec3(face[2])) / 3.0;
            if ((middle - top_m).norm() < within_m)
            {
                faces.push_back(i);
            }
        }
        return faces;
    }

    static constexpr double kRadius_m = 0.004;
    static constexpr double kPressed_m = kRadius_m - 0.001;

    const TestModel& model_ = editable_plate();
    EditedSoup soup{model_, kEditRoom};
    Random random = Random::seeded(seed_of(6'500));
    EditAuthor author{soup, random};
    std::optional<FrameRig> rig_;
    std::optional<SafeForce> force_;
    Vec3 top_m{0.0, 0.0, 0.0};
    FrameOutput output;
    Vec3 sent_n{0.0, 0.0, 0.0};
    double step_n{0.0};
};

/// Change of force in a frame while 8 N fade in kFadeTime_s, or return in kRiseTime_s.
constexpr double kMostFadeStep_n = 2.0 * 8.0 * 1e-3 / kFadeTime_s;
constexpr double kMostRiseStep_n = 2.0 * 8.0 * 1e-3 / kRiseTime_s;

TEST(EditEffects, removing_the_support_of_a_tool_lets_its_force_go_in_small_steps)
{
    PressedPlate sut;
    ASSERT_NO_FATAL_FAILURE(sut.press());
    const std::vector<std::uint32_t> hole = sut.top_faces(1.5 * PressedPlate::kRadius_m);
    ASSERT_GT(hole.size(), 20U);
    ASSERT_LE(hole.size(), kMaxEditFaces);
    sut.send(sut.author.removal_of(hole));
    for (int i = 0; i < 300; ++i)
    {
        sut.step(PressedPlate::kPressed_m);
        ASSERT_LE(sut.step_n, kMostFadeStep_n) << i;
        const BracketVerdict verdict =
            judge_bracket(sut.soup.oracle(), sut.output.pairs[0], ObjectPose{});
        ASSERT_EQ(verdict.text, "") << i;
    }
    EXPECT_EQ(sut.sent_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_FALSE(sut.output.tools[0].in_contact);
    EXPECT_EQ(sut.output.models[0].edit_revision, 1U);
}

TEST(EditEffects, a_face_that_is_added_over_a_tool_makes_no_force_until_the_tool_is_clear_of_it)
{
    PressedPlate sut;
    ASSERT_NO_FATAL_FAILURE(sut.press());
    const double before_n = sut.sent_n.norm();
    const std::vector<std::uint32_t> hole = sut.top_faces(1.5 * PressedPlate::kRadius_m);
    sut.send(sut.author.removal_of(hole));
    for (int i = 0; i < 200; ++i)
    {
        sut.step(PressedPlate::kPressed_m);
    }
    OwnedEdit fill = sut.author.removal_of({});
    ASSERT_NO_FATAL_FAILURE(sut.add_equals(fill, hole));
    sut.send(fill);
    for (int i = 0; i < 100; ++i)
    {
        sut.step(PressedPlate::kPressed_m);
        ASSERT_EQ(sut.output.tools[0].force_n, Vec3(0.0, 0.0, 0.0)) << i;
        ASSERT_FALSE(sut.output.pairs[0].is_joined) << i;
    }
    for (int i = 0; i < 200; ++i)
    {
        sut.step(PressedPlate::kPressed_m + 1e-4 * i);
        ASSERT_LE(sut.step_n, kMostRiseStep_n) << i;
    }
    EXPECT_TRUE(sut.output.pairs[0].is_joined);
    ASSERT_NO_FATAL_FAILURE(sut.press());
    EXPECT_NEAR(sut.sent_n.norm(), before_n, 1e-6);
}

TEST(EditEffects, coarse_faces_round_a_hole_are_split_even_within_the_tolerance)
{
    PressedPlate sut(0.1);
    ASSERT_NO_FATAL_FAILURE(sut.press());
    const std::uint32_t refined = sut.output.models[0].refined_records;
    sut.send(sut.author.removal_of(sut.top_faces(0.5 * PressedPlate::kRadius_m)));
    for (int i = 0; i < 50; ++i)
    {
        sut.step(PressedPlate::kPressed_m);
        const BracketVerdict verdict =
            judge_bracket(sut.soup.oracle(), sut.output.pairs[0], ObjectPose{});
        ASSERT_EQ(verdict.text, "") << i;
    }
    EXPECT_GT(sut.output.models[0].refined_records, refined);
    // They stay split under a tool that moves to and fro, and are not merged in vain.
    const Vec3 top_m = sut.top_m;
    std::uint32_t merges = 0;
    for (int i = 0; i < 600; ++i)
    {
        sut.top_m = top_m + Vec3(0.0005 * std::sin(0.05 * i), 0.0, 0.0);
        sut.step(PressedPlate::kPressed_m);
        merges += i < 300 ? 0 : sut.output.work.merges;
    }
    EXPECT_EQ(merges, 0U);
    EXPECT_TRUE(sut.output.pairs[0].kind == AnswerKind::exact ||
                sut.output.pairs[0].kind == AnswerKind::within_tolerance);
}

TEST(EditEffects, an_edit_draws_on_the_budget_of_its_frame)
{
    PressedPlate sut;
    for (int i = 0; i < 50; ++i)
    {
        sut.step(0.05); // Far away: hardly any other work.
    }
    OwnedEdit edit = sut.author.removal_of({});
    ASSERT_NO_FATAL_FAILURE(sut.add_equals(edit, sut.top_faces(1.5 * PressedPlate::kRadius_m)));
    ASSERT_GT(edit.added.size(), 20U);
    sut.send(edit);
    sut.step(0.05);
    const WorkCounters& work = sut.output.work;
    const auto faces = static_cast<std::uint32_t>(edit.added.size());
    const std::uint32_t refits = work.blocks_refitted + work.nodes_refitted;
    ASSERT_GT(refits, 0U);
    EXPECT_GE(work.budget.used(), faces * WorkCost::edited_face + refits * WorkCost::refit);
}

TEST(EditEffects, equal_faces_in_place_of_the_touched_ones_are_felt_as_nothing)
{
    PressedPlate sut;
    ASSERT_NO_FATAL_FAILURE(sut.press());
    const Vec3 before_n = sut.sent_n;
    const std::vector<std::uint32_t> touched = sut.top_faces(1.5 * PressedPlate::kRadius_m);
    OwnedEdit edit = sut.author.removal_of(touched);
    ASSERT_NO_FATAL_FAILURE(sut.add_equals(edit, touched));
    sut.send(edit);
    for (int i = 0; i < 100; ++i)
    {
        sut.step(PressedPlate::kPressed_m);
        ASSERT_NEAR((sut.sent_n - before_n).norm(), 0.0, 0.05) << i;
    }
}

TEST(EditEffects, of_a_model_that_is_refined_fully_are_exact_in_the_frame_of_the_edit)
{
    const TestModel& model = small_model(1);
    Random random = Random::seeded(seed_of(6'510));
    EditedSoup soup(model, kEditRoom);
    EditAuthor author(soup, random);
    RigOptions options = whole_options(model.faces.size() + kEditRoom);
    options.edit_faces = kEditRoom;
    options.tools = {{0.01 * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.tools[0].wants_distance = true;
    options.tools[0].query_only = true;
    FrameRig rig(model, options);
    refine_fully(model.name, [&](const Budgets& budgets)
                 { return rig.step(to_vec3(model.faces[0][0]), budgets); });
    WanderingOperator hand(model, random);
    const std::uint32_t frames = trial_length(800);
    for (std::uint32_t frame = 0; frame < frames; ++frame)
    {
        const Vec3 goal_m = hand.next();
        const OwnedEdit edit = author.next(goal_m);
        rig.edit(edit.view());
        soup.apply(edit);
        const FrameOutput output = rig.step(goal_m);
        const PairOutput& pair = output.pairs[0];
        ASSERT_EQ(output.models[0].edit_revision, soup.revision());
        ASSERT_EQ(pair.kind, AnswerKind::exact) << "frame " << frame;
        const BracketVerdict verdict = judge_bracket(soup.oracle(), pair, ObjectPose{});
        ASSERT_EQ(verdict.text, "") << "frame " << frame;
    }
}

TEST(EditEffects, may_remove_every_face_and_bring_all_back)
{
    const TestModel& model = test_model("effects-least", make_uv_sphere(4, 7).value(), 20);
    Random random = Random::seeded(seed_of(6'520));
    EditedSoup soup(model, 1'000);
    EditAuthor author(soup, random);
    RigOptions options = editable_options(0.01 * model.diagonal_m);
    options.edit_faces = 1'000;
    FrameRig rig(model, options);
    const FaceTree tree(model.faces);
    const Vec3 inside_m = 0.5 * (tree.low_m() + tree.high_m());
    const Vec3 outside_m = inside_m + Vec3(0.0, 0.0, 0.4 * model.diagonal_m);
    rig.settle(outside_m, {}, 400);
    std::vector<std::uint32_t> all(soup.source().faces.size());
    std::iota(all.begin(), all.end(), 0U);
    ASSERT_LE(all.size(), kMaxEditFaces);
    const OwnedEdit nothing = author.removal_of(all);
    rig.edit(nothing.view());
    soup.apply(nothing);
    FrameOutput output;
    for (int i = 0; i < 400; ++i)
    {
        output = rig.step(Vec3(outside_m + i / 399.0 * (inside_m - outside_m)));
        ASSERT_EQ(output.pairs[0].upper_m, kInfinity) << i;
        ASSERT_EQ(output.tools[0].force_n, Vec3(0.0, 0.0, 0.0)) << i;
    }
    EXPECT_NEAR((output.tools[0].proxy_m - inside_m).norm(), 0.0, 1e-12);
    OwnedEdit again = author.removal_of({});
    for (const SourceFace& face : soup.source().faces)
    {
        ASSERT_TRUE(author.add(again, face.corners, face.bucket));
    }
    rig.edit(again.view());
    soup.apply(again);
    for (int i = 0; i < 400 && output.pairs[0].kind != AnswerKind::separated; ++i)
    {
        output = rig.step(inside_m);
        ASSERT_EQ(judge_bracket(soup.oracle(), output.pairs[0], ObjectPose{}).text, "") << i;
    }
    EXPECT_EQ(output.pairs[0].kind, AnswerKind::separated);
    // From inside, the tool is held by the added faces.
    for (int i = 0; i < 400; ++i)
    {
        output = rig.step(Vec3(inside_m + i / 399.0 * (outside_m - inside_m)));
    }
    EXPECT_TRUE(output.tools[0].in_contact);
    EXPECT_GT(output.tools[0].force_n.norm(), 0.3);
    EXPECT_GE(static_cast<double>(brute_distance(output.tools[0].proxy_m, soup.model().faces)),
              0.999 * 0.01 * model.diagonal_m);
}

/// A rig with refused edits beside one without.
class RefusedEdits : public testing::TestWithParam<EditRefusal>
{
};

TEST_P(RefusedEdits, are_counted_and_change_nothing)
{
    const TestModel& model = small_model(1);
    Random random = Random::seeded(seed_of(6'530));
    EditedSoup soup(model, 600);
    EditAuthor author(soup, random);
    RigOptions options = editable_options(0.01 * model.diagonal_m);
    options.edit_faces = 600;
    FrameRig sut(model, options);
    FrameRig twin(model, options);
    WanderingOperator hand(model, random);
    std::uint32_t refused = 0;
    const std::uint32_t frames = trial_length(1'200);
    for (std::uint32_t frame = 0; frame < frames; ++frame)
    {
        const Vec3 goal_m = hand.next();
        const bool is_full = GetParam() == EditRefusal::too_many && random.one_in(4);
        for (std::uint32_t i = 0; i < (is_full ? 2U : random.one_in(10) ? 1U : 0U); ++i)
        {
            const OwnedEdit edit = author.next(goal_m);
            sut.edit(edit.view());
            twin.edit(edit.view());
            soup.apply(edit);
        }
        std::uint32_t sent = 0;
        const bool is_sent = GetParam() == EditRefusal::too_many ? is_full : random.one_in(4);
        if (const auto bad = is_sent ? author.bad(GetParam(), goal_m) : std::nullopt)
        {
            const bool is_unknown = GetParam() == EditRefusal::unknown_model;
            sut.edit(bad->view(ModelId{is_unknown ? 1U : 0U}));
            sent = 1;
        }
        const FrameOutput output = sut.step(goal_m);
        const FrameOutput expected = twin.step(goal_m);
        ASSERT_EQ(difference_of(output, expected), "") << "frame " << frame;
        for (std::size_t i = 0; i < kEditRefusals; ++i)
        {
            const bool is_it = i == static_cast<std::size_t>(GetParam());
            ASSERT_EQ(output.scene.edits_refused[i], is_it ? sent : 0U)
                << kEditRefusalNames[i] << ", frame " << frame;
        }
        refused += sent;
    }
    EXPECT_GT(refused, 20U);
}

INSTANTIATE_TEST_SUITE_P(EachReason, RefusedEdits,
                         testing::Values(EditRefusal::too_many, EditRefusal::unknown_model,
                                         EditRefusal::wrong_revision, EditRefusal::too_large,
                                         EditRefusal::unknown_face, EditRefusal::bad_face),
                         [](const auto& one)
                         { return kEditRefusalNames[static_cast<std::size_t>(one.param)]; });

TEST(EditEffects, a_model_without_room_refuses_every_edit)
{
    const TestModel& model = small_model(1);
    Random random = Random::seeded(seed_of(6'540));
    EditedSoup soup(model, 600);
    EditAuthor author(soup, random);
    RigOptions options = editable_options(0.01 * model.diagonal_m);
    options.edit_faces = 0;
    FrameRig sut(model, options);
    const OwnedEdit edit = author.next(to_vec3(model.faces[0][0]));
    sut.edit(edit.view());
    const FrameOutput output = sut.step(to_vec3(model.faces[0][0]));
    EXPECT_EQ(output.scene.edits_refused[static_cast<std::size_t>(EditRefusal::unknown_model)], 1U);
    EXPECT_EQ(output.models[0].edit_revision, 0U);
    EXPECT_EQ(output.models[0].added.capacity, 0U);
}

TEST(EditEffects, room_that_is_never_used_changes_no_bit)
{
    for (const std::size_t index : {0U, 1U, 2U, 4U})
    {
        const TestModel& model = small_model(index);
        Random random = Random::seeded(seed_of(6'550 + index));
        RigOptions options = editable_options(0.01 * model.diagonal_m);
        FrameRig sut(model, options);
        options.edit_faces = 0;
        FrameRig usual(model, options);
        WanderingOperator hand(model, random);
        const std::uint32_t frames = trial_length(1'600);
        for (std::uint32_t frame = 0; frame < frames; ++frame)
        {
            const Vec3 goal_m = hand.next();
            const FrameOutput output = sut.step(goal_m);
            const FrameOutput expected = usual.step(goal_m);
            ASSERT_EQ(difference_of(output, expected), "") << model.name << ", frame " << frame;
        }
    }
}

TEST(EditEffects, frames_that_take_edits_allocate_nothing)
{
    if (!allocation_counter::available())
    {
        GTEST_SKIP() << "no allocation counter under this sanitizer";
    }
    const TestModel& model = small_model(1);
    Random random = Random::seeded(seed_of(6'560));
    EditedSoup soup(model, 600);
    EditAuthor author(soup, random);
    RigOptions options = editable_options(0.01 * model.diagonal_m);
    options.edit_faces = 600;
    FrameRig rig(model, options);
    WanderingOperator hand(model, random);
    const auto calls = []
    {
        const allocation_counter::HeapCalls all = allocation_counter::of_this_thread();
        return all.allocations + all.frees;
    };
    const std::uint64_t before = calls();
    std::uint32_t made = 0;
    std::uint32_t refused = 0;
    for (std::uint32_t frame = 0; frame < trial_length(1'200); ++frame)
    {
        rig.deliver();
        ToolState state;
        state.position_m = hand.next();
        std::vector<OwnedEdit> owned;
        const auto reason = static_cast<EditRefusal>(random.below(kEditRefusals));
        if (const auto bad = author.bad(reason, state.position_m))
        {
            const bool is_fine =
                reason == EditRefusal::too_many || reason == EditRefusal::unknown_model;
            if (!is_fine)
            {
                owned.push_back(*bad);
                ++refused;
            }
        }
        owned.push_back(author.next(state.position_m));
        soup.apply(owned.back());
        ++made;
        std::vector<SurfaceEdit> edits;
        for (const OwnedEdit& edit : owned)
        {
            edits.push_back(edit.view());
        }
        FrameInput input{std::span(&state, 1), {}, {}, rig.now_ns()};
        input.edits = edits;
        allocation_counter::mark_this_thread(true);
        const FrameOutput output = rig.frame().run(input);
        allocation_counter::mark_this_thread(false);
        ASSERT_EQ(output.models[0].edit_revision, soup.revision());
    }
    EXPECT_EQ(calls(), before);
    EXPECT_GT(made, 100U);
    EXPECT_GT(refused, 20U);
}

} // namespace
} // namespace tactus::test
