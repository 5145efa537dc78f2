// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Scenes with any set of a frame's shortcuts: exact answers, contacts and forces are as with all
/// of them, to the bit if the query starts warm.

#include "tests/property/frame_checks.hpp"
#include "tests/stability/scene_trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kTwinTools = 3;
constexpr std::uint32_t kTwinObjects = 6;
constexpr int kTwinFrames = 900;
constexpr int kCalmFrames = 100; ///< Frames at the start in which nothing moves.
/// Tolerance in newtons, metres, and lengths of differences of unit vectors.
constexpr double kAlike = 1e-9;

/// Amount of compared data.
struct Compared
{
    std::uint32_t rested{0};        ///< Resting tools, with all shortcuts.
    std::uint32_t frames_rested{0}; ///< Resting frames, with all shortcuts.
    std::uint32_t outputs{0};       ///< Outputs of tools.
    std::uint32_t touches{0};       ///< Outputs in contact.
    std::uint32_t answers{0};
    std::uint32_t contacts{0};
    std::uint32_t came{0}; ///< Objects with the number of an earlier one.
};

/// A cold start visits the same triangles in another order: forces, and normals at edges and
/// vertices, are sums with other rounding. So are the distances of streamed models, whose trees
/// have grown differently.
bool are_near(const ToolOutput& a, const ToolOutput& b)
{
    return (a.force_n - b.force_n).norm() <= kAlike && (a.proxy_m - b.proxy_m).norm() <= kAlike &&
           a.in_contact == b.in_contact && a.halted == b.halted &&
           a.over_constrained == b.over_constrained;
}

/// Events of both rigs: tools that rest, wander and press into nearby objects, among objects that
/// do the same, are removed, and appear anywhere.
class TwinEvents
{
public:
    TwinEvents(Random random, const std::vector<const TestModel*>& models)
        : random_(random), models_(models), objects_(kTwinObjects)
    {
        for (std::uint32_t i = 0; i < kTwinObjects; ++i)
        {
            objects_[i].model = model_of(i);
            objects_[i].pose = any_pose(random_, 1.2 * diagonal_m());
        }
        for (Vec3& goal : goals_m_)
        {
            goal = random_.in_cube(diagonal_m());
        }
        targets_m_ = goals_m_;
    }

    [[nodiscard]] static ModelId model_of(std::uint32_t object)
    {
        return ModelId{object % 3 == 1 ? 1U : 0U};
    }
    [[nodiscard]] const ObjectPose& pose(std::uint32_t object) const
    {
        return objects_[object].pose;
    }
    [[nodiscard]] const std::vector<Vec3>& goals_m() const { return goals_m_; }
    [[nodiscard]] const std::vector<SceneChange>& changes() const { return changes_; }

    void next(double step_m)
    {
        changes_.clear();
        for (std::uint32_t i = 0; i < kTwinTools; ++i)
        {
            if (random_.one_in(100)) // Motion to a corner of some object and slightly into it.
            {
                const Object& object = objects_[random_.below(kTwinObjects)];
                const auto& faces = models_[object.model.value]->faces;
                const auto& face = faces[random_.below(faces.size())];
                targets_m_[i] = to_world(object.pose, 0.99 * to_vec3(face[0]));
            }
            const Vec3 way = targets_m_[i] - goals_m_[i];
            goals_m_[i] =
                way.norm() > step_m ? Vec3(goals_m_[i] + step_m * way.normalized()) : targets_m_[i];
        }
        if (random_.one_in(60))
        {
            change_object(random_.below(kTwinObjects));
        }
    }

private:
    struct Object
    {
        ModelId model{};
        ObjectPose pose;
        std::uint32_t generation{0};
        bool is_resident{true};
    };

    [[nodiscard]] double diagonal_m() const { return models_[0]->diagonal_m; }

    void change_object(std::uint32_t number)
    {
        Object& object = objects_[number];
        SceneChange change;
        change.number = number;
        if (!object.is_resident)
        {
            change.kind = SceneChangeKind::object_comes;
            change.object = {object.model, {400.0, 0.4, 0.3, 0.1}};
            object.pose = any_pose(random_, 1.2 * diagonal_m());
            ++object.generation;
            object.is_resident = true;
        }
        else if (random_.one_in(3))
        {
            change.kind = SceneChangeKind::object_goes;
            object.is_resident = false;
        }
        else
        {
            object.pose.translation_m += 0.002 * random_.in_cube(diagonal_m());
        }
        change.generation = object.generation;
        change.pose = object.pose;
        changes_.push_back(change);
    }

    Random random_;
    const std::vector<const TestModel*>& models_;
    std::vector<Object> objects_;
    std::vector<Vec3> goals_m_{kTwinTools};
    std::vector<Vec3> targets_m_;
    std::vector<SceneChange> changes_;
};

/// One scene with all shortcuts, and with a random set of them. Resident models: every answer
/// behind a force is exact. Streamed models: compares answers that both know exactly, and forces of
/// tools that have been free and known since they last were not.
class ShortcutTwins
{
public:
    ShortcutTwins(std::uint64_t seed, bool streams, Compared& compared)
        : streams_(streams)
        , compared_(compared)
        , random_(Random::seeded(seed))
        , usual_(models_, options(FrameVariant{}))
        , variant_(any_variant(random_))
        , sut_(models_, options(variant_))
        , events_(random_, models_)
    {
        for (std::uint32_t i = 0; i < kTwinObjects; ++i)
        {
            usual_.place_object(events_.pose(i), i);
            sut_.place_object(events_.pose(i), i);
        }
    }

    void run()
    {
        for (int frame = 0; frame < kTwinFrames; ++frame)
        {
            SCOPED_TRACE("frame " + std::to_string(frame));
            if (frame > kCalmFrames)
            {
                events_.next(0.6e-3 * kSpeed_m_per_s);
            }
            for (const SceneChange& change : events_.changes())
            {
                usual_.change(change);
                sut_.change(change);
                compared_.came += change.kind == SceneChangeKind::object_comes ? 1U : 0U;
            }
            const FrameOutput expected = usual_.step(events_.goals_m(), {});
            const FrameOutput output = sut_.step(events_.goals_m(), {});
            compared_.rested += skipped(expected, Skip::tools);
            compared_.frames_rested += skipped(expected, Skip::frames);
            for (std::uint32_t i = 0; i < kTwinTools; ++i)
            {
                ASSERT_NO_FATAL_FAILURE(compare_tool(expected, output, i));
            }
            for (const PairOutput& pair : expected.pairs)
            {
                ASSERT_NO_FATAL_FAILURE(compare_pair(pair, output));
            }
        }
    }

private:
    static constexpr double kSpeed_m_per_s = 1.0;

    [[nodiscard]] RigOptions options(const FrameVariant& variant) const
    {
        RigOptions options = with_room_for_all();
        options.tools.assign(kTwinTools, ToolSpec{radius_m(), 500.0, 8.0, kSpeed_m_per_s});
        for (ToolSpec& tool : options.tools)
        {
            tool.wants_contacts = true;
        }
        for (std::uint32_t i = 0; i < kTwinObjects; ++i)
        {
            options.objects.push_back({TwinEvents::model_of(i), {400.0, 0.4, 0.3, 0.1}});
        }
        options.faults.delay_polls_max = 8;
        options.static_when_it_fits = !streams_;
        options.variant = variant;
        return options;
    }
    [[nodiscard]] double radius_m() const { return 0.01 * models_[0]->diagonal_m; }
    [[nodiscard]] static std::uint32_t skipped(const FrameOutput& output, Skip skip)
    {
        return output.work.skipped.times()[static_cast<std::size_t>(skip)];
    }
    /// True if all answers behind a tool's force are known.
    [[nodiscard]] static bool is_known(const FrameOutput& output, std::uint32_t tool)
    {
        return std::ranges::none_of(
            output.pairs, [tool](const PairOutput& pair)
            { return pair.tool == tool && pair.kind == AnswerKind::bounded; });
    }

    /// A moving or waiting proxy moves as far as is known, which shortcuts do change: it is not
    /// compared until it is at the same place again.
    void compare_tool(const FrameOutput& expected, const FrameOutput& output, std::uint32_t i)
    {
        ToolOutput ours = output.tools[i];
        const ToolOutput& theirs = expected.tools[i];
        ours.clear_m = theirs.clear_m; // Clearance of objects without a pair.
        const bool is_alike = variant_.starts_warm ? ours == theirs : are_near(ours, theirs);
        const auto waits = [this, i](const FrameOutput& one)
        {
            const ToolOutput& tool = one.tools[i];
            return tool.under_way ||
                   (streams_ && (tool.data_limited || tool.halted || !is_known(one, i)));
        };
        const bool stays_apart = !is_alike || (streams_ && ours.in_contact);
        has_a_way_[i] = (has_a_way_[i] && stays_apart) || waits(expected) || waits(output);
        ASSERT_TRUE(is_alike || has_a_way_[i])
            << "tool " << i << ": force " << ours.force_n.transpose() << " and "
            << theirs.force_n.transpose();
        compared_.outputs += has_a_way_[i] ? 0U : 1U;
        compared_.touches += ours.in_contact && !has_a_way_[i] ? 1U : 0U;
    }

    void compare_pair(const PairOutput& pair, const FrameOutput& output)
    {
        const auto same =
            std::ranges::find_if(output.pairs, [&pair](const PairOutput& one)
                                 { return one.tool == pair.tool && one.object == pair.object; });
        if (same == output.pairs.end())
        {
            ASSERT_TRUE(has_a_way_[pair.tool]);
            return;
        }
        if (same->point_m != pair.point_m || pair.kind != AnswerKind::exact ||
            same->kind != AnswerKind::exact)
        {
            return;
        }
        ++compared_.answers;
        SCOPED_TRACE("tool " + std::to_string(pair.tool) + ", object " +
                     std::to_string(pair.object));
        ASSERT_EQ(same->nearest_face, pair.nearest_face);
        if (streams_ && !variant_.starts_warm) // Both hold the truth, with different rounding.
        {
            ASSERT_LE(same->lower_m, pair.upper_m);
            ASSERT_GE(same->upper_m, pair.lower_m);
        }
        else
        {
            ASSERT_EQ(same->lower_m, pair.lower_m);
            ASSERT_EQ(same->upper_m, pair.upper_m);
        }
        if (pair.contacts->is_complete && same->contacts->is_complete)
        {
            compare_contacts(*pair.contacts, *same->contacts);
        }
    }

    void compare_contacts(const ContactReport& theirs, const ContactReport& ours)
    {
        EXPECT_EQ(ours.side, theirs.side);
        EXPECT_LE((ours.normal - theirs.normal).norm(), variant_.starts_warm ? 0.0 : kAlike);
        if (streams_ && !variant_.starts_warm)
        {
            compared_.contacts += static_cast<std::uint32_t>(ours.contacts.size());
            ASSERT_NO_FATAL_FAILURE(expect_contacts(ours, theirs));
            ASSERT_NO_FATAL_FAILURE(expect_contacts(theirs, ours));
            return;
        }
        ASSERT_EQ(ours.contacts.size(), theirs.contacts.size());
        for (std::size_t i = 0; i < ours.contacts.size(); ++i)
        {
            const Contact& a = ours.contacts[i];
            const Contact& b = theirs.contacts[i];
            ++compared_.contacts;
            ASSERT_EQ(a.face, b.face);
            ASSERT_EQ(a.feature, b.feature);
            ASSERT_EQ(a.distance_m, b.distance_m);
            ASSERT_EQ(a.on_tool_m, b.on_tool_m);
            ASSERT_EQ(a.on_surface_m, b.on_surface_m);
            ASSERT_EQ(a.normal, b.normal);
        }
    }

    /// Compares reports of distances with different rounding: contacts at the limit are in one
    /// report only, and equally near ones are in another order.
    void expect_contacts(const ContactReport& some, const ContactReport& others)
    {
        for (const Contact& contact : some.contacts)
        {
            const auto* const same =
                std::ranges::find(others.contacts, contact.face, &Contact::face);
            if (same == others.contacts.end())
            {
                ASSERT_GE(contact.distance_m, radius_m() - kAlike);
                continue;
            }
            ASSERT_EQ(contact.feature, same->feature);
            ASSERT_NEAR(contact.distance_m, same->distance_m, kAlike);
        }
    }

    bool streams_;
    Compared& compared_;
    Random random_;
    std::vector<const TestModel*> models_{&small_model(0), &small_model(2)};
    FrameRig usual_;
    FrameVariant variant_;
    FrameRig sut_;
    TwinEvents events_;
    std::vector<bool> has_a_way_ = std::vector<bool>(kTwinTools, false);
};

Compared run_twins(std::uint64_t first, bool streams)
{
    Compared compared;
    for (std::uint64_t trial = 0; trial < 16 && !testing::Test::HasFatalFailure(); ++trial)
    {
        const std::uint64_t seed = seed_of(first + trial);
        SCOPED_TRACE("seed " + std::to_string(seed));
        ShortcutTwins(seed, streams, compared).run();
    }
    return compared;
}

TEST(SceneShortcuts, in_any_set_of_them_change_no_exact_answer_no_contact_and_no_force)
{
    const Compared compared = run_twins(2'200, false);
    EXPECT_GT(compared.rested, 1'000U);
    EXPECT_GT(compared.frames_rested, 500U);
    EXPECT_GT(compared.outputs, 16U * 900U * kTwinTools / 2U);
    EXPECT_GT(compared.touches, 1'000U);
    EXPECT_GT(compared.contacts, 1'000U);
    EXPECT_GT(compared.came, 16U);
}

TEST(SceneShortcuts, change_nothing_that_is_known_of_models_that_stream)
{
    const Compared compared = run_twins(2'220, true);
    EXPECT_GT(compared.rested, 500U);
    EXPECT_GT(compared.outputs, 16U * 900U * kTwinTools / 4U);
    EXPECT_GT(compared.answers, 2'000U);
    EXPECT_GT(compared.touches, 200U);
    EXPECT_GT(compared.contacts, 1'000U);
    EXPECT_GT(compared.came, 16U);
}

/// I5 with a tolerance: answers differ, but their bounds hold.
TEST(FrameTolerance, splits_less_and_says_less)
{
    const TestModel& model = small_model(0);
    const double tolerance_m = 2e-3 * model.diagonal_m;
    const std::uint64_t seed = seed_of(1'790);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    RigOptions options;
    options.tools = {{0.02 * model.diagonal_m, 500.0, 8.0, 10.0}};
    options.tools[0].query_only = true;
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
    options.tools[0].query_only = true;
    std::uint32_t last = 0;
    const Vec3 goal = place_at_distance(model, random, 0.005 * model.diagonal_m);
    for (const double factor : {1.0, 2.0, 4.0})
    {
        options.variant.fixed_radius = factor;
        FrameRig sut(model, options);
        sut.settle(goal, {}, 2'000);
        EXPECT_TRUE(answer_is_sound(model, sut.step(goal)));
        const std::uint32_t refined = sut.model().forest.refined_records();
        EXPECT_GT(refined, last);
        last = refined;
    }
}

} // namespace
} // namespace tactus::test
