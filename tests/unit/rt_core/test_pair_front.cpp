// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A front changes the work but no answer: each query that continues from the last one is compared
/// with the same query from the roots, and with all pairs measured one by one.

#include "rt_core/query/mesh_query.hpp"
#include "rt_core/query/pair_front.hpp"
#include "tests/unit/rt_core/mesh_support.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <set>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kAllOfThem = std::numeric_limits<std::uint32_t>::max();

/// Adds, moves or removes some faces.
void change(TreeRig& rig, Random& random, std::uint32_t count, bool exact_only)
{
    const FaceStyle& style = face_styles()[random.below(5)];
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        const std::uint32_t prim = random.below(count);
        if (random.one_in(3) && !rig.face(prim).face.is_none() && rig.present().size() > 1)
        {
            rig.remove(prim);
            continue;
        }
        ChangedFace face = random_face(random, style, prim, 3 * prim + 1);
        face.error = exact_only ? 0 : face.error;
        rig.put(face);
    }
    rig.sut->refit();
}

enum class Kind : std::uint8_t
{
    whole,
    meeting,
    first_meeting,
    nearest,
};

/// Query of a tool at an object, with its own memory.
struct Asker
{
    const TreeRig& tool;
    const TreeRig& object;
    PairFront* front;
    MeshMemory memory{};
    ErrorCode tolerance{0}; ///< Tolerance of both models in queries of the whole.

    [[nodiscard]] Asked ask(Kind kind, const MeshPlacement& place, double reach, double certified,
                            const WalkBudget& budget = kAmple)
    {
        Asked answers;
        const MeshQuestion question{*tool.sut,
                                    *object.sut,
                                    place,
                                    reach,
                                    0.5 * reach,
                                    nullptr,
                                    certified,
                                    kAllMeetingFaces,
                                    front,
                                    kind == Kind::whole ? tolerance : ErrorCode{0},
                                    kind == Kind::whole ? tolerance : ErrorCode{0}};
        OtherSurface surface(*object.sut, place, budget);
        switch (kind)
        {
        case Kind::whole:
            query_meshes(question, surface, memory, answers.answer, answers.report,
                         answers.contacts);
            break;
        case Kind::nearest:
            find_nearest_faces(question, surface, memory, answers.answer, answers.report);
            break;
        case Kind::meeting:
        case Kind::first_meeting:
            find_meeting_faces(question, kind == Kind::meeting ? kAllOfThem : 1, surface.budget(),
                               memory, answers.report);
            break;
        }
        answers.budget = surface.budget();
        return answers;
    }
};

/// Expects equality to the last bit, except for the order of meeting pairs and the width of bounds
/// beyond the reach.
void expect_same(const Asked& one, const Asked& other, Kind kind)
{
    ASSERT_EQ(one.report.intersection, other.report.intersection);
    ASSERT_EQ(one.report.is_complete, other.report.is_complete);
    ASSERT_EQ(one.answer.kind, other.answer.kind);
    if (one.answer.kind == AnswerKind::exact || kind != Kind::whole)
    {
        ASSERT_EQ(one.answer.lower_m, other.answer.lower_m);
        ASSERT_EQ(one.answer.upper_m, other.answer.upper_m);
    }
    const bool ends_with_one = kind == Kind::first_meeting || kind == Kind::nearest;
    if (ends_with_one && one.report.intersection == Intersection::proven)
    {
        return;
    }
    ASSERT_EQ(as_set(one.report.meeting), as_set(other.report.meeting));
    ASSERT_EQ(one.answer.nearest_face, other.answer.nearest_face);
    ASSERT_EQ(one.report.nearest_tool_face, other.report.nearest_tool_face);
    ASSERT_TRUE(same_contacts(one.contacts, other.contacts));
}

/// Motion of a tool that drifts, rests, reverses, and sometimes jumps.
class Motion
{
public:
    explicit Motion(Random& random) : random_(random), place_(random_placement(random)) { turn(); }

    [[nodiscard]] const MeshPlacement& next()
    {
        if (random_.one_in(12))
        {
            const double scale = place_.place.scale; // Tools keep their scale, with one exception.
            place_ = random_placement(random_);
            place_.place.scale = random_.one_in(4) ? place_.place.scale : scale;
            place_.place.translation_m.y() += random_.between(0.0, 2.0);
        }
        else if (random_.one_in(6))
        {
            turn();
        }
        else if (!random_.one_in(8))
        {
            step_ = random_.one_in(5) ? Vec3(-step_) : step_;
            place_.place.translation_m += step_;
            place_.place.rotation = spin_ * place_.place.rotation;
        }
        return place_;
    }

private:
    void turn()
    {
        const double pace = std::exp2(random_.between(-14.0, -2.0));
        step_ = random_.in_cube(pace);
        spin_ = Eigen::AngleAxisd(random_.between(-pace, pace),
                                  (random_.in_cube(1.0) + Vec3(2, 0, 0)).normalized())
                    .toRotationMatrix();
    }

    Random& random_;
    MeshPlacement place_;
    Vec3 step_{0.0, 0.0, 0.0};
    Mat3 spin_{Mat3::Identity()};
};

} // namespace

TEST(PairFront, changes_no_answer_however_the_tool_goes_and_the_trees_change)
{
    Random random(101);
    int met = 0;
    int apart = 0;
    int coarse = 0;
    int tolerant = 0;
    for (int round = 0; round < 15; ++round)
    {
        const bool is_tool_exact = round % 3 != 0;
        const bool is_object_exact = round % 4 != 0;
        auto [tool, object] = Meshes(random, is_tool_exact, is_object_exact);
        const auto front = std::make_unique<PairFront>();
        Asker sut{tool, object, front.get()};
        Motion motion(random);
        for (int query = 0; query < 60; ++query)
        {
            if (random.one_in(10))
            {
                random.one_in(2) ? change(tool, random, 80, is_tool_exact)
                                 : change(object, random, 120, is_object_exact);
            }
            const MeshPlacement& place = motion.next();
            const AllPairs truth(tool.present(), object.present(), place, -1.0);
            const auto kind = static_cast<Kind>(random.below(4));
            const double reach = random.between(0.0, 0.3);
            const double certified = random.one_in(2) && truth.coarse_lower > 0.0
                                         ? truth.coarse_lower * random.between(0.0, 0.999)
                                         : 0.0;
            if (random.one_in(8))
            {
                const WalkBudget little{random.below(60), random.below(400)};
                static_cast<void>(sut.ask(kind, place, reach, certified, little));
            }
            if (random.one_in(4))
            {
                sut.tolerance =
                    static_cast<ErrorCode>(random.one_in(3) ? 0 : 40 + random.below(21));
            }
            Asker from_the_roots{tool, object, nullptr, sut.memory, sut.tolerance};

            const Asked answers = sut.ask(kind, place, reach, certified);

            ASSERT_NO_FATAL_FAILURE(
                expect_same(answers, from_the_roots.ask(kind, place, reach, certified), kind))
                << round << " " << query;
            const bool is_all = kind == Kind::whole || kind == Kind::meeting;
            const std::set<MeetingFaces> meeting = as_set(answers.report.meeting);
            if (is_all)
            {
                ASSERT_EQ(meeting, truth.meeting) << round << " " << query;
            }
            ASSERT_EQ(meeting.empty(), truth.meeting.empty()) << round << " " << query;
            tolerant += kind == Kind::whole && sut.tolerance != 0 ? 1 : 0;
            const bool is_distance = kind == Kind::nearest || kind == Kind::whole;
            const double lower = std::max(0.0, std::min(truth.upper, truth.coarse_lower));
            if (is_distance)
            {
                ASSERT_LE(answers.answer.lower_m, lower + 1e-13) << round << " " << query;
                ASSERT_GE(answers.answer.upper_m, lower - 1e-13) << round << " " << query;
            }
            if (is_distance && answers.answer.kind == AnswerKind::exact && sut.tolerance == 0)
            {
                ASSERT_NEAR(answers.answer.upper_m, truth.upper, 1e-13 * (1.0 + truth.upper));
            }
            met += truth.meeting.empty() ? 0 : 1;
            apart += truth.meeting.empty() ? 1 : 0;
            coarse += truth.coarse_lower < kInfinity ? 1 : 0;
        }
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(apart, 100);
    EXPECT_GT(coarse, 100);
    EXPECT_GT(tolerant, 50);
}

TEST(PairFront, leaves_little_to_look_at_while_the_tool_goes_slowly_and_nothing_while_it_rests)
{
    Random random(102);
    std::uint64_t with = 0;
    std::uint64_t without = 0;
    for (int round = 0; round < 10; ++round)
    {
        const auto [tool, object] = Meshes(random);
        const auto front = std::make_unique<PairFront>();
        Asker sut{tool, object, front.get()};
        Asker from_the_roots{tool, object, nullptr};
        MeshPlacement place = random_placement(random);
        place.place.translation_m.y() += 0.5;
        for (int query = 0; query < 30; ++query)
        {
            place.place.translation_m.x() += 1e-5;
            const Asked answers = sut.ask(Kind::meeting, place, 0.0, 0.0);
            const Asked from_roots = from_the_roots.ask(Kind::meeting, place, 0.0, 0.0);
            ASSERT_LE(answers.budget.nodes_visited, from_roots.budget.nodes_visited);
            with += answers.budget.nodes_visited;
            without += from_roots.budget.nodes_visited;
        }
        const Asked moved = sut.ask(Kind::meeting, place, 0.0, 0.0);
        const Asked rested = sut.ask(Kind::meeting, place, 0.0, 0.0);
        EXPECT_LE(rested.budget.nodes_visited, moved.budget.nodes_visited);
    }
    EXPECT_LT(4 * with, 3 * without); // Meeting pairs are always evaluated.
    EXPECT_GT(without, 1'000U);
}

TEST(PairFront, knows_nothing_after_a_walk_of_more_than_kRoom_pairs)
{
    Random random(103);
    TreeRig tool({1'500, 800, 800});
    TreeRig object({1'500, 800, 800});
    fill(tool, random, 1'500, true);
    fill(object, random, 1'500, true);
    const auto front = std::make_unique<PairFront>();
    Asker sut{tool, object, front.get()};
    Asker from_the_roots{tool, object, nullptr};
    const MeshPlacement same;

    const Asked answers = sut.ask(Kind::meeting, same, 0.0, 0.0);

    EXPECT_EQ(front->count, 0U);
    ASSERT_GT(answers.budget.nodes_visited, PairFront::kRoom);
    expect_same(answers, from_the_roots.ask(Kind::meeting, same, 0.0, 0.0), Kind::meeting);
    MeshPlacement away;
    away.place.translation_m.y() = 3.0;
    for (std::uint32_t i = 0; i < PairFront::kPause; ++i)
    {
        static_cast<void>(sut.ask(Kind::meeting, away, 0.0, 0.0));
        EXPECT_EQ(front->count, 0U);
    }
    static_cast<void>(sut.ask(Kind::meeting, away, 0.0, 0.0));
    EXPECT_GT(front->count, 0U);
}

TEST(PairFront, counts_a_motion_at_least_as_long_as_that_of_any_point)
{
    Random random(104);
    for (int round = 0; round < 2'000; ++round)
    {
        const MeshPlacement before = random_placement(random);
        MeshPlacement now = random_placement(random);
        now.place.scale = random.one_in(2) ? before.place.scale : now.place.scale;
        if (random.one_in(2))
        {
            now.place.rotation =
                before.place.rotation * Eigen::AngleAxisd(std::exp2(random.between(-30.0, 1.0)),
                                                          random.in_cube(1.0).normalized())
                                            .toRotationMatrix();
        }
        const Sphere sphere{random.in_cube(1.0), random.between(0.0, 2.0)};
        const double motion = motion_between(before, now, sphere);
        for (int point = 0; point < 5; ++point)
        {
            const Vec3 at = sphere.center + sphere.radius * random.in_cube(1.0).normalized();
            ASSERT_GE(motion + 1e-14, (now.local_to_world(at) - before.local_to_world(at)).norm());
        }
    }
}

} // namespace tactus::test
