// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/mesh_query.hpp"
#include "rt_core/query/near_faces.hpp"
#include "rt_core/query/unfinished_search.hpp"
#include "tests/unit/rt_core/mesh_support.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace tactus::test
{

namespace
{

/// Random placement, lifted by up to `most`.
MeshPlacement lifted_placement(Random& random, double most)
{
    MeshPlacement place = random_placement(random);
    place.place.translation_m.y() += random.between(0.0, most);
    return place;
}

/// Runs a query until `enough` meeting pairs are found.
Asked ask_for(std::uint32_t enough, const TreeRig& tool, const TreeRig& object,
              const MeshPlacement& place, double reach, double contact, MeshMemory& memory,
              const WalkBudget& budget = kAmple, double certified = 0.0,
              ContactEnds* ends = nullptr, const Tolerances& tolerances = {})
{
    Asked asked;
    OtherSurface surface(*object.sut, place, budget);
    query_meshes({*tool.sut, *object.sut, place, reach, contact, ends, certified, enough, nullptr,
                  tolerances.tool, tolerances.object},
                 surface, memory, asked.answer, asked.report, asked.contacts);
    asked.budget = surface.budget();
    return asked;
}

Asked ask(const TreeRig& tool, const TreeRig& object, const MeshPlacement& place, double reach,
          double contact, MeshMemory& memory, const WalkBudget& budget = kAmple,
          double certified = 0.0, ContactEnds* ends = nullptr)
{
    return ask_for(kAllMeetingFaces, tool, object, place, reach, contact, memory, budget, certified,
                   ends);
}

/// Query of up to `enough` meeting pairs.
Asked ask_meeting(const TreeRig& tool, const TreeRig& object, const MeshPlacement& place,
                  std::uint32_t enough, MeshMemory& memory, const WalkBudget& budget = kAmple)
{
    Asked asked;
    asked.budget = budget;
    find_meeting_faces({*tool.sut, *object.sut, place}, enough, asked.budget, memory, asked.report);
    return asked;
}

/// Query of the least distance.
Asked ask_nearest(const TreeRig& tool, const TreeRig& object, const MeshPlacement& place,
                  MeshMemory& memory, const WalkBudget& budget = kAmple)
{
    Asked asked;
    OtherSurface surface(*object.sut, place, budget);
    find_nearest_faces({*tool.sut, *object.sut, place}, surface, memory, asked.answer,
                       asked.report);
    asked.budget = surface.budget();
    return asked;
}

} // namespace

/// Least distance from a face of the tool to the object, minus both errors, in the tool frame.
double gap_of(const ChangedFace& own, std::span<const ChangedFace> object,
              const MeshPlacement& place)
{
    const double scale = place.place.scale;
    double gap = kInfinity;
    for (const ChangedFace& face : object)
    {
        const ClosestPoints closest =
            closest_points(placed(own, place), to_triangle(face.corners_m));
        gap = std::min(gap, (closest.distance - error_of(face)) / scale - error_of(own));
    }
    return gap;
}

/// Reported gap of a lane; infinity beyond the bound.
double told_gap(const NearFaces& near, std::uint32_t block, std::uint32_t lane)
{
    for (const NearFaces::Block& found : near.blocks())
    {
        if (found.index == block && (found.lanes >> lane & 1U) != 0)
        {
            return near.gap_m(found, lane);
        }
    }
    return kInfinity;
}

/// Faces of the tool in the form of a star, within its capacity.
struct LooseStar
{
    BlockGeometry geometry;
    BlockSide side;
    std::vector<ChangedFace> faces;

    explicit LooseStar(std::span<const ChangedFace> from)
    {
        for (const ChangedFace& face : from)
        {
            if (add_to_block(geometry, side, face) < kBlockFaces)
            {
                faces.push_back(face);
            }
        }
    }
};

/// Expects a tight lower bound; nothing more is reported for faces that may already meet.
void expect_told(double told, double truth, double bound)
{
    ASSERT_TRUE(told < kInfinity || truth > bound);
    ASSERT_LE(std::min(told, bound), std::max(truth, 0.0));
    ASSERT_TRUE(told == kInfinity || told >= truth - 0.01);
}

TEST(NearFaces, are_all_above_the_tolerance_and_within_the_bound_with_their_gaps)
{
    Random random(84);
    int near_ones = 0;
    int far_ones = 0;
    for (int round = 0; round < 60; ++round)
    {
        const auto [tool, object] = Meshes(random, false, round % 3 == 0, false);
        const auto faces = object.present();
        for (int query = 0; query < 4; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            const MeshPlacement place = lifted_placement(random, 1.5);
            const double bound = random.between(0.0, 0.5);
            const auto tolerance = static_cast<ErrorCode>(random.one_in(2) ? random.below(60) : 0);
            OtherSurface other(*object.sut, place, kAmple);
            NearFaces sut(*tool.sut, other, tolerance);
            sut.find(bound);
            ASSERT_EQ(sut.rest_m(), kInfinity);
            for (const ChangedFace& own : tool.present())
            {
                const std::uint32_t leaf = tool.sut->leaf_of(own.prim);
                const double told = told_gap(sut, leaf / kBlockFaces, leaf % kBlockFaces);
                const double truth = own.error <= tolerance ? kInfinity : gap_of(own, faces, place);
                ASSERT_TRUE(own.error > tolerance || told == kInfinity);
                expect_told(told, truth, bound);
                near_ones += truth <= bound ? 1 : 0;
                far_ones += truth > bound ? 1 : 0;
            }

            const LooseStar star(tool.present());
            LooseFaces loose{star.geometry};
            for (std::uint32_t lane = 0; lane < star.faces.size(); ++lane)
            {
                loose.lanes |= star.faces[lane].error != 0 ? 1U << lane : 0U;
                loose.errors_m[lane] = error_of(star.faces[lane]);
            }
            if (loose.lanes == 0)
            {
                continue;
            }
            NearFaces of_star(*tool.sut, other, 0);
            of_star.find(loose, bound);
            ASSERT_EQ(of_star.rest_m(), kInfinity);
            for (std::uint32_t lane = 0; lane < star.faces.size(); ++lane)
            {
                const ChangedFace& own = star.faces[lane];
                expect_told(told_gap(of_star, kNoNode, lane),
                            own.error == 0 ? kInfinity : gap_of(own, faces, place), bound);
            }
        }
    }
    EXPECT_GT(near_ones, 200);
    EXPECT_GT(far_ones, 500);
}

/// Expects for every coarse face of the tool a report not above the truth.
void expect_nothing_missed(const NearFaces& near, const TreeRig& tool, const TreeRig& object,
                           const MeshPlacement& place, double bound)
{
    const auto faces = object.present();
    for (const ChangedFace& own : tool.present())
    {
        const std::uint32_t leaf = tool.sut->leaf_of(own.prim);
        const double told = std::min(told_gap(near, leaf / kBlockFaces, leaf % kBlockFaces),
                                     std::min(near.rest_m(), bound));
        ASSERT_TRUE(own.error == 0 || told <= std::max(gap_of(own, faces, place), 0.0));
    }
}

TEST(NearFaces, are_left_where_a_budget_ends_the_search_or_a_face_may_be_anywhere)
{
    Random random(85);
    int cut_short = 0;
    for (int round = 0; round < 40; ++round)
    {
        const bool lacks_room = round % 4 == 0;
        TreeRig tool({80, 200, 200});
        TreeRig object({60, lacks_room ? 4U : 200U, lacks_room ? 2U : 200U});
        const bool is_one_block = round % 2 == 1; // One block each, with nothing else.
        fill(tool, random, 1 + random.below(is_one_block ? 5 : 80), false);
        fill(object, random, is_one_block ? 5 : 60, false);
        const MeshPlacement place = random_placement(random);
        const std::uint32_t share = random.below(is_one_block ? 20 : 300);
        // The budget is of nodes or, to end between two blocks, of triangles.
        const WalkBudget budget =
            is_one_block ? WalkBudget{10'000, share} : WalkBudget{share, 10 * share};
        OtherSurface other(*object.sut, place, budget);
        NearFaces sut(*tool.sut, other, 0);
        const double bound = is_one_block ? 3.0 : 0.3;
        sut.find(bound);
        expect_nothing_missed(sut, tool, object, place, bound);
        cut_short += sut.rest_m() < kInfinity ? 1 : 0;
        ASSERT_TRUE(object.sut->is_complete() || sut.rest_m() <= 0.0);
    }
    EXPECT_GT(cut_short, 5);
}

/// Least gap of all coarse faces.
double least_gap(const TreeRig& tool, const TreeRig& object, const MeshPlacement& place)
{
    const auto faces = object.present();
    double least = kInfinity;
    for (const ChangedFace& own : tool.present())
    {
        least = own.error == 0 ? least : std::min(least, gap_of(own, faces, place));
    }
    return std::max(least, 0.0);
}

TEST(NearFaces, of_a_search_that_was_cut_are_left_to_those_that_go_on_with_it)
{
    Random random(91);
    std::uint32_t finished_later = 0;
    std::uint32_t changed = 0;
    for (int round = 0; round < 60; ++round)
    {
        auto [tool, object] = Meshes(random, false, round % 3 == 0, false);
        MeshPlacement place = lifted_placement(random, 1.5);
        const double bound = random.between(0.2, 0.8);
        const double step = random.one_in(2) ? 0.0 : random.between(0.0, 0.004);
        UnfinishedSearch unfinished;
        double moved = 0.0;
        std::uint32_t parts = 0;
        do
        {
            const WalkBudget budget{2 + random.below(12U), 200};
            OtherSurface other(*object.sut, place, budget);
            NearFaces sut(*tool.sut, other, 0);
            sut.find(bound, NearFaces::kAll, &unfinished);
            expect_nothing_missed(sut, tool, object, place, bound);
            if (unfinished.left.empty())
            {
                const double told = std::clamp(sut.rest_m(), 0.0, bound);
                ASSERT_GE(told,
                          std::min(least_gap(tool, object, place), bound) - 2.0 * moved - 0.02);
                finished_later += parts > 0 ? 1U : 0U;
            }
            place.place.translation_m += step * random.in_cube(1.0).normalized();
            unfinished.moved_m += step / place.place.scale;
            moved += step / place.place.scale;
            ++parts;
            if (parts == 3 && round % 4 == 0 && !unfinished.left.empty())
            {
                fill(object, random, 3, round % 8 == 0);
                moved = 0.0; // The motion is counted again.
                ++changed;
            }
        } while (!unfinished.left.empty() && parts < 200);
        ASSERT_LT(parts, 200U) << round;
    }
    EXPECT_GT(finished_later, 20U);
    EXPECT_GT(changed, 3U);
}

TEST(NearFaces, are_left_where_there_are_more_blocks_of_them_than_kMaxNearBlocks)
{
    Random random(86);
    constexpr std::uint32_t kMany = 1'600;
    TreeRig tool({kMany, kMany, kMany});
    TreeRig object({4, 20, 20});
    fill(tool, random, kMany, false);
    fill(object, random, 4, true);
    OtherSurface other(*object.sut, MeshPlacement{}, kAmple);
    NearFaces sut(*tool.sut, other, 0);
    sut.find(9.0);
    EXPECT_EQ(sut.blocks().size(), kMaxNearBlocks);
    EXPECT_LE(sut.rest_m(), 9.0);
    expect_nothing_missed(sut, tool, object, MeshPlacement{}, 9.0);
}

TEST(NearFaces, are_no_longer_looked_for_once_enough_were_found)
{
    Random random(87);
    std::uint32_t ended = 0;
    for (int round = 0; round < 60; ++round)
    {
        const auto [tool, object] = Meshes(random, false, round % 3 == 0, false);
        const MeshPlacement place = lifted_placement(random, 0.5);
        const double bound = random.between(0.0, 0.5);
        OtherSurface all_of_other(*object.sut, place, kAmple);
        NearFaces all(*tool.sut, all_of_other, 0);
        all.find(bound);
        OtherSurface other(*object.sut, place, kAmple);
        NearFaces sut(*tool.sut, other, 0);
        const std::uint32_t enough = 1 + random.below(20);
        sut.find(bound, enough);
        std::uint32_t found = 0;
        for (const NearFaces::Block& block : sut.blocks())
        {
            found += count_lanes(block.lanes);
        }
        const bool has_ended = sut.rest_m() < kInfinity;
        ASSERT_TRUE(!has_ended || found >= enough) << round;
        ASSERT_LE(other.budget().nodes_visited, all_of_other.budget().nodes_visited) << round;
        expect_nothing_missed(sut, tool, object, place, bound);
        ended += has_ended ? 1 : 0;
    }
    EXPECT_GT(ended, 5U);
}

TEST(OtherSurface, is_no_nearer_than_all_of_its_faces_less_their_errors)
{
    Random random(71);
    for (int round = 0; round < 60; ++round)
    {
        TreeRig object({200, 400, 400});
        fill(object, random, 1 + random.below(200), round % 2 == 0);
        const MeshPlacement place = random_placement(random);
        OtherSurface sut(*object.sut, place, kAmple);
        for (int query = 0; query < 30; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            const Vec3 point = random.in_cube(3.0);
            double truth = kInfinity;
            for (const ChangedFace& face : object.present())
            {
                const ClosestPoint closest = closest_point_on_triangle(place.local_to_world(point),
                                                                       to_triangle(face.corners_m));
                truth = std::min(truth, std::sqrt(closest.distance_sq) - error_of(face));
            }
            truth = std::max(0.0, truth) / place.place.scale;
            const double enough = random.one_in(2) ? kInfinity : random.between(0.0, 1.0);

            const double lower = sut.lower_bound_m({point, 0.0}, enough);

            ASSERT_LE(lower, truth);
            ASSERT_GE(lower, std::min(truth, enough) - 0.02); // Rounding of single precision.
            ASSERT_LE(sut.lower_bound_m({point, 0.25}, enough), truth - 0.25);
            ASSERT_GE(sut.upper_bound_m({point, 0.25}), truth + 0.25);
            if (round % 2 == 0)
            {
                ASSERT_LE(sut.upper_bound_m({point, 0.25}), truth + 0.25 + 1e-12);
            }
        }
    }
}

TEST(OtherSurface, says_nothing_when_its_budget_is_spent)
{
    Random random(76);
    TreeRig object({200, 400, 400});
    fill(object, random, 200, true);
    OtherSurface sut(*object.sut, MeshPlacement{}, {3, 40});
    for (int i = 0; i < 10; ++i)
    {
        static_cast<void>(sut.lower_bound_m({Vec3(0.0, 0.0, 9.0), 0.5}, kInfinity));
    }
    EXPECT_TRUE(sut.budget().is_spent);
    EXPECT_LE(sut.lower_bound_m({Vec3(0.0, 0.0, 9.0), 0.5}, kInfinity), -0.5);
}

TEST(MeshPlacement, has_an_inverse)
{
    Random random(72);
    for (int i = 0; i < 1'000; ++i)
    {
        const MeshPlacement place = random_placement(random);
        const Vec3 point = random.in_cube(2.0);
        EXPECT_LT((place.inverse().local_to_world(place.local_to_world(point)) - point).norm(),
                  1e-14);
    }
}

TEST(MeshQuery, finds_what_measuring_all_pairs_finds_with_a_tolerance_and_without)
{
    Random random(73);
    int met = 0;
    int touching = 0;
    std::map<AnswerKind, int> exactly;
    std::map<AnswerKind, int> tolerantly;
    for (int round = 0; round < 240; ++round)
    {
        const int half = round / 2;
        const bool is_tolerant = round % 2 == 1;
        const auto [tool, object] = is_tolerant
                                        ? Meshes(random, half % 4 == 0, half % 4 == 1, false)
                                        : Meshes(random, half % 3 != 0, half % 4 != 0, false);
        const std::uint32_t least = half % 3 == 0 ? 0 : 45; // Most faces are within the tolerance.
        const auto code = [&]
        { return static_cast<ErrorCode>(is_tolerant ? least + random.below(61 - least) : 0); };
        Tolerances tolerances;
        tolerances.tool = code();
        tolerances.object = code();
        MeshMemory memory;
        MeshMemory of_meeting{
            {static_cast<std::uint32_t>(7 * half % 10), static_cast<std::uint32_t>(3 * half % 10)}};
        for (int query = 0; query < 8; ++query)
        {
            SCOPED_TRACE(std::to_string(round) + " " + std::to_string(query));
            const MeshPlacement place = lifted_placement(random, 1.4);
            const double reach = random.between(0.0, is_tolerant ? 0.5 : 0.2);
            const double contact = random.one_in(4) ? -1.0 : reach * random.between(0.0, 1.0);
            const AllPairs truth(tool.present(), object.present(), place, contact, tolerances);
            const double certified =
                is_tolerant && random.one_in(2)
                    ? std::max(truth.coarse_lower, 0.0) * random.between(0.0, 1.0)
                    : 0.0;

            const Asked asked = ask_for(kAllMeetingFaces, tool, object, place, reach, contact,
                                        memory, kAmple, certified, nullptr, tolerances);

            const DistanceAnswer& answer = asked.answer;
            ++(is_tolerant ? tolerantly : exactly)[answer.kind];
            ASSERT_LE(answer.lower_m, truth.lower + 1e-14);
            ASSERT_LE(answer.lower_m, answer.upper_m);
            ASSERT_GE(answer.upper_m, truth.lower);
            // Meetings of exact faces are found, independent of all others.
            ASSERT_EQ(as_set(asked.report.meeting), truth.meeting);
            ASSERT_TRUE(std::is_sorted(asked.report.meeting.begin(), asked.report.meeting.end()));
            ASSERT_EQ(asked.report.intersection == Intersection::proven, !truth.meeting.empty());
            met += truth.meeting.empty() ? 0 : 1;
            const double apart = (answer.nearest_point_m - answer.tool_point_m).norm();
            if (!is_tolerant)
            {
                // The query of meeting faces alone finds the same.
                ASSERT_EQ(asked.report.is_complete, truth.coarse_lower > 0.0);
                ASSERT_EQ(asked.report.intersection, truth.intersection());
                const MeshReport meeting =
                    ask_meeting(tool, object, place, 1'000'000, of_meeting).report;
                ASSERT_EQ(as_set(meeting.meeting), truth.meeting);
                ASSERT_TRUE(std::is_sorted(meeting.meeting.begin(), meeting.meeting.end()));
                ASSERT_EQ(meeting.is_complete, truth.coarse_lower > 0.0);
                ASSERT_EQ(meeting.intersection, truth.intersection());
                if (answer.kind == AnswerKind::exact)
                {
                    ASSERT_LE(apart, answer.upper_m + 1e-13);
                    ASSERT_GE(apart, answer.lower_m - 1e-13);
                    ASSERT_NEAR(truth.upper, answer.upper_m, 1e-13);
                }
            }
            else
            {
                ASSERT_GE(answer.upper_m, std::min(truth.upper, truth.corners) - 1e-14);
                ASSERT_TRUE(asked.report.intersection != Intersection::none ||
                            truth.is_all_known());
            }
            if (answer.kind == AnswerKind::within_tolerance)
            {
                ASSERT_GT(answer.tolerated_m, 0.0);
                ASSERT_FALSE(answer.nearest_face.is_none());
                ASSERT_NEAR(apart, truth.surface, 1e-13);
                ASSERT_GE(answer.lower_m, truth.surface - answer.tolerated_m - 1e-13);
            }
            if (contact >= 0.0 && truth.in_contact.size() <= kMaxContacts)
            {
                std::set<MeetingFaces> found;
                for (const Contact& contact_found : asked.contacts.contacts)
                {
                    found.insert({contact_found.tool_face, contact_found.face});
                }
                ASSERT_EQ(found, truth.in_contact);
                ASSERT_TRUE(!asked.contacts.is_complete || truth.coarse_lower > contact);
                ASSERT_TRUE(is_tolerant || asked.contacts.is_complete ||
                            truth.coarse_lower <= contact);
                touching += found.empty() ? 0 : 1;
            }
        }
    }
    EXPECT_GT(exactly[AnswerKind::exact], 60);
    EXPECT_GT(exactly[AnswerKind::separated], 100);
    EXPECT_GT(tolerantly[AnswerKind::within_tolerance], 30);
    EXPECT_GT(tolerantly[AnswerKind::bounded], 25);
    EXPECT_GT(met, 100);
    EXPECT_GT(touching, 50);
}

/// Contacts of a tool that wants no pairs need only one that meets.
TEST(MeshQuery, that_wants_one_pair_ends_with_it_and_is_else_the_same)
{
    Random random(89);
    int met = 0;
    int apart = 0;
    for (int round = 0; round < 200; ++round)
    {
        const Meshes meshes(random, round % 3 != 0, round % 3 != 1);
        const MeshPlacement place = lifted_placement(random, 1.0);
        const double reach = random.between(0.0, 0.1);
        const double contact = round % 2 == 0 ? -1.0 : reach;
        const AllPairs truth(meshes.tool.present(), meshes.object.present(), place, reach);
        MeshMemory memory{{random.below(10), random.below(10)}};
        MeshMemory same = memory;
        MeshMemory of_meeting;
        const Asked all = ask(meshes.tool, meshes.object, place, reach, contact, memory);
        for (int again = 0; again < 2; ++again)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", again " + std::to_string(again));
            const Asked sut = ask_for(1, meshes.tool, meshes.object, place, reach, contact, same);

            ASSERT_EQ(sut.report.intersection, truth.intersection());
            ASSERT_EQ(sut.report.meeting.size(), truth.meeting.empty() ? 0U : 1U);
            const Asked any = ask_meeting(meshes.tool, meshes.object, place, 1, of_meeting);
            ASSERT_EQ(any.report.intersection, truth.intersection());
            ASSERT_EQ(any.report.meeting.size(), truth.meeting.empty() ? 0U : 1U);
            ASSERT_EQ(any.report.is_complete, truth.meeting.empty() && truth.coarse_lower > 0.0);
            ASSERT_FALSE(any.report.is_truncated);
            if (truth.meeting.empty())
            {
                ++apart;
                // Bounds beyond the reach depend on the memory.
                const bool varies = again == 1 || contact >= 0.0;
                ASSERT_TRUE(varies || sut.answer.lower_m == all.answer.lower_m);
                ASSERT_TRUE(varies || sut.answer.upper_m == all.answer.upper_m);
                ASSERT_EQ(sut.answer.kind, all.answer.kind);
                ASSERT_EQ(sut.report.is_complete, all.report.is_complete);
                ASSERT_TRUE(truth.intersection() != Intersection::none ||
                            same_contacts(sut.contacts, all.contacts));
                continue;
            }
            ++met;
            ASSERT_EQ(sut.answer.kind, AnswerKind::exact);
            ASSERT_EQ(sut.answer.lower_m, 0.0);
            ASSERT_EQ(sut.answer.upper_m, 0.0);
            ASSERT_TRUE(truth.meeting.contains(sut.report.meeting[0]));
            ASSERT_EQ(sut.report.nearest_tool_face, sut.report.meeting[0].tool_face);
            ASSERT_EQ(sut.answer.nearest_face, sut.report.meeting[0].face);
            ASSERT_FALSE(sut.report.is_complete);
            ASSERT_TRUE(contact < 0.0 || !sut.contacts.is_complete);
            ASSERT_TRUE(again == 0 || contact >= 0.0 || sut.budget.nodes_visited == 1);
            // The last meeting pair is tried first.
            ASSERT_TRUE(again == 0 || any.budget.nodes_visited == 1);
            ASSERT_TRUE(truth.meeting.contains(any.report.meeting[0]));
        }
    }
    EXPECT_GT(met, 80);
    EXPECT_GT(apart, 80);
}

/// Moves the coarse faces of a rig away from all others.
void part_coarse(TreeRig& rig, float by)
{
    for (ChangedFace face : rig.present())
    {
        for (Vec3f& corner : face.corners_m)
        {
            corner[2] += face.error != 0 ? by : 0.0F;
        }
        rig.put(face);
    }
    rig.sut->refit();
}

TEST(MeshQuery, is_the_same_with_less_work_where_coarse_faces_are_known_to_be_far)
{
    Random random(88);
    int known = 0;
    int met = 0;
    std::uint64_t tested = 0;
    std::uint64_t tested_knowing = 0;
    for (int round = 0; round < 60; ++round)
    {
        Meshes meshes(random, round % 3 == 0, round % 3 == 1);
        const float by = random.one_in(2) ? 0.0F : static_cast<float>(random.between(0.5, 4.0));
        part_coarse(meshes.tool, by);
        part_coarse(meshes.object, -by);
        const auto tool_faces = meshes.tool.present();
        const auto faces = meshes.object.present();
        for (int query = 0; query < 4; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            const MeshPlacement place = lifted_placement(random, 0.5);
            const double reach = random.between(0.0, 0.1);
            const double contact = random.one_in(2) ? -1.0 : reach;
            const AllPairs truth(tool_faces, faces, place, contact);
            MeshMemory memory{{random.below(10), random.below(10)}};
            MeshMemory same = memory;
            const Asked plain = ask(meshes.tool, meshes.object, place, reach, contact, memory);

            const Asked asked = ask(meshes.tool, meshes.object, place, reach, contact, same, kAmple,
                                    std::max(0.0, truth.coarse_lower - 1e-9));

            ASSERT_EQ(as_set(asked.report.meeting), truth.meeting);
            ASSERT_EQ(asked.report.intersection, plain.report.intersection);
            ASSERT_EQ(asked.report.is_complete, plain.report.is_complete);
            ASSERT_EQ(asked.report.nearest_tool_face, plain.report.nearest_tool_face);
            ASSERT_EQ(asked.answer.kind, plain.answer.kind);
            ASSERT_GE(asked.answer.upper_m, truth.lower);
            ASSERT_TRUE(asked.answer.kind != AnswerKind::exact ||
                        asked.answer.upper_m == plain.answer.upper_m);
            ASSERT_EQ(asked.answer.nearest_face, plain.answer.nearest_face);
            ASSERT_LE(asked.answer.lower_m, truth.lower + 1e-14);
            ASSERT_EQ(asked.answer.certified_radius_m, plain.answer.certified_radius_m);
            ASSERT_EQ(asked.contacts.is_complete, plain.contacts.is_complete);
            ASSERT_EQ(asked.contacts.contacts.size(), plain.contacts.contacts.size());
            const bool is_known = truth.coarse_lower > 1.0 && truth.coarse_lower < kInfinity &&
                                  plain.answer.upper_m < truth.coarse_lower - 1e-9;
            known += is_known ? 1 : 0;
            met += is_known && !truth.meeting.empty() ? 1 : 0;
            tested += is_known ? plain.budget.triangles_tested : 0;
            tested_knowing += is_known ? asked.budget.triangles_tested : 0;
        }
    }
    EXPECT_GT(known, 30);
    EXPECT_GT(met, 10);
    EXPECT_LT(tested_knowing, tested);
}

TEST(NearestFaces, are_those_of_all_pairs_however_far_and_whatever_is_remembered)
{
    Random random(83);
    int exact = 0;
    int met = 0;
    for (int round = 0; round < 50; ++round)
    {
        const auto [tool, object] = Meshes(random, round % 3 != 0, round % 4 != 0, false);
        MeshMemory memory{{random.below(10), random.below(10), random.below(20), 0}};
        for (int query = 0; query < 6; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            MeshPlacement place = random_placement(random);
            if (!random.one_in(2))
            {
                const double share = random.between(0.0, 1.0);
                place.place.translation_m.y() += share * std::exp2(random.below(8));
            }
            const AllPairs truth(tool.present(), object.present(), place, 0.0);
            MeshMemory none;

            const Asked asked = ask_nearest(tool, object, place, memory);
            const Asked anew = ask_nearest(tool, object, place, none);

            const DistanceAnswer& answer = asked.answer;
            ASSERT_LE(answer.lower_m, truth.lower + 1e-14);
            ASSERT_GE(answer.upper_m, truth.lower);
            ASSERT_EQ(asked.report.intersection, truth.intersection());
            ASSERT_TRUE(std::ranges::all_of(asked.report.meeting,
                                            [&truth](const MeetingFaces& faces)
                                            { return truth.meeting.contains(faces); }));
            ASSERT_EQ(answer.kind, anew.answer.kind);
            ASSERT_EQ(answer.lower_m, anew.answer.lower_m);
            if (answer.kind != AnswerKind::exact)
            {
                ASSERT_LE(truth.coarse_lower, answer.upper_m);
                continue;
            }
            ++exact;
            met += truth.meeting.empty() ? 0 : 1;
            ASSERT_EQ(answer.upper_m, anew.answer.upper_m);
            ASSERT_NEAR(answer.upper_m, truth.upper, 1e-13 * (1.0 + truth.upper));
            ASSERT_NEAR((answer.nearest_point_m - answer.tool_point_m).norm(), truth.upper,
                        1e-13 * (1.0 + truth.upper));
            ASSERT_FALSE(answer.nearest_face.is_none());
            ASSERT_FALSE(asked.report.nearest_tool_face.is_none());
            if (truth.meeting.empty())
            {
                ASSERT_EQ(answer.nearest_face, anew.answer.nearest_face);
                ASSERT_EQ(asked.report.nearest_tool_face, anew.report.nearest_tool_face);
            }
        }
    }
    EXPECT_GT(exact, 100);
    EXPECT_GT(met, 15);
}

TEST(NearestFaces, are_bracketed_where_the_budget_ends_the_search)
{
    Random random(84);
    int cut = 0;
    int lower_known = 0;
    for (int round = 0; round < 40; ++round)
    {
        const auto [tool, object] = Meshes(random);
        const MeshPlacement place = lifted_placement(random, 8.0);
        const AllPairs truth(tool.present(), object.present(), place, 0.0);
        for (std::uint32_t nodes = 1; nodes < 3'000; nodes *= 3)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", nodes " + std::to_string(nodes));
            MeshMemory memory{{random.below(10), random.below(10)}};
            const Asked asked =
                ask_nearest(tool, object, place, memory, {nodes, random.below(10 * nodes)});
            const DistanceAnswer& answer = asked.answer;
            ASSERT_LE(asked.budget.nodes_visited, nodes);
            ASSERT_LE(answer.lower_m, truth.lower + 1e-14);
            ASSERT_GE(answer.upper_m, truth.lower);
            ASSERT_TRUE(asked.report.intersection != Intersection::none || truth.meeting.empty());
            ASSERT_TRUE(answer.kind != AnswerKind::exact ||
                        answer.upper_m <= truth.upper + 1e-13 * (1.0 + truth.upper));
            cut += answer.kind == AnswerKind::bounded ? 1 : 0;
            lower_known += answer.kind == AnswerKind::bounded && answer.lower_m > 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(cut, 50);
    EXPECT_GT(lower_known, 10);
}

TEST(NearestFaces, are_not_told_by_faces_that_are_gone)
{
    // The tree changes between two questions, so remembered pairs are measured again.
    Random random(85);
    for (int round = 0; round < 8; ++round)
    {
        auto [tool, object] = Meshes(random);
        const MeshPlacement place = random_placement(random);
        MeshMemory memory;
        for (int change = 0; change < 8; ++change)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", change " + std::to_string(change));
            const AllPairs truth(tool.present(), object.present(), place, 0.0);
            const Asked asked = ask_nearest(tool, object, place, memory);
            ASSERT_EQ(asked.report.intersection, truth.intersection());
            ASSERT_NEAR(asked.answer.upper_m, truth.upper, 1e-13 * (1.0 + truth.upper));
            ASSERT_EQ(ask_meeting(tool, object, place, 1, memory).report.intersection,
                      truth.intersection());
            // The nearest face of the object is removed.
            for (const ChangedFace& face : object.present())
            {
                if (face.face == asked.answer.nearest_face)
                {
                    object.remove(face.prim.value);
                }
            }
            object.sut->refit();
        }
    }
}

TEST(MeshQuery, faces_that_only_touch_meet)
{
    // A mesh on itself: all faces with a common corner, edge or plane meet, without a margin for
    // the filters.
    Random random(80);
    int met = 0;
    for (int round = 0; round < 40; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        TreeRig tool({60, 200, 200});
        TreeRig object({60, 200, 200});
        fill(tool, random, 60, true);
        for (ChangedFace face : tool.present())
        {
            object.put(face);
        }
        object.sut->refit();
        MeshPlacement place;
        place.offset_m = Vec3(0.0, random.below(2) * 0.5, 0.0);
        const AllPairs truth(tool.present(), object.present(), place, 0.0);
        met += truth.meeting.empty() ? 0 : 1;
        MeshMemory memory;

        const Asked asked = ask(tool, object, place, 0.0, -1.0, memory);
        EXPECT_EQ(as_set(asked.report.meeting), truth.meeting);
        // Each decided pair counts.
        EXPECT_GE(asked.budget.triangles_tested, truth.meeting.size());
        EXPECT_EQ(as_set(ask_meeting(tool, object, place, 1'000'000, memory).report.meeting),
                  truth.meeting);
    }
    EXPECT_GT(met, 20);
}

TEST(MeshQuery, beyond_single_precision_bounds_what_it_can)
{
    Random random(81);
    const auto [tool, object] = Meshes(random);
    for (const double far_m : {1e6, 1e8, 1e12})
    {
        SCOPED_TRACE(far_m);
        MeshPlacement place = random_placement(random);
        place.place.translation_m = Vec3(far_m, -far_m, 0.0);
        const AllPairs truth(tool.present(), object.present(), place, -1.0);
        MeshMemory memory{{0, 0}};

        const Asked asked = ask(tool, object, place, 0.1, 0.1, memory);

        EXPECT_LE(asked.answer.lower_m, truth.lower);
        EXPECT_GT(asked.answer.lower_m, 0.8 * truth.lower);
        EXPECT_GE(asked.answer.upper_m, truth.lower);
        EXPECT_EQ(asked.answer.kind, AnswerKind::separated);
        EXPECT_EQ(asked.report.intersection, Intersection::none);
        EXPECT_EQ(ask_meeting(tool, object, place, 1, memory).report.intersection,
                  Intersection::none);
    }
}

TEST(MeshQuery, a_place_that_is_no_number_proves_nothing)
{
    Random random(82);
    const auto [tool, object] = Meshes(random);
    MeshPlacement place = random_placement(random);
    place.place.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
    MeshMemory memory{{0, 0}};

    const Asked asked = ask(tool, object, place, 0.1, 0.1, memory);

    EXPECT_NE(asked.answer.kind, AnswerKind::separated);
    EXPECT_LE(asked.answer.lower_m, 0.0);
    EXPECT_EQ(asked.report.intersection, Intersection::open);
    EXPECT_FALSE(asked.report.is_complete);
    EXPECT_EQ(ask_meeting(tool, object, place, 1, memory).report.intersection, Intersection::open);
}

TEST(MeshQuery, a_spent_budget_leaves_all_that_it_says_true)
{
    Random random(74);
    int spent = 0;
    int open = 0;
    for (int round = 0; round < 40; ++round)
    {
        const auto [tool, object] = Meshes(random);
        const MeshPlacement place = random_placement(random);
        const AllPairs truth(tool.present(), object.present(), place, 0.05);
        for (std::uint32_t share = 1; share < 3'000; share *= 3)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", share " + std::to_string(share));
            MeshMemory memory{{random.below(10), random.below(10)}};
            MeshMemory same = memory;
            const WalkBudget budget{share, random.below(10 * share)};
            const Asked whole = ask(tool, object, place, 0.05, 0.05, memory, budget);
            ASSERT_LE(whole.answer.lower_m, truth.lower + 1e-14);
            ASSERT_GE(whole.answer.upper_m, truth.lower);
            const Asked meeting = ask_meeting(tool, object, place, 1'000'000, same, budget);
            for (const Asked* asked : {&whole, &meeting})
            {
                const MeshReport& report = asked->report;
                const auto found = as_set(report.meeting);
                ASSERT_TRUE(std::includes(truth.meeting.begin(), truth.meeting.end(), found.begin(),
                                          found.end()));
                ASSERT_TRUE(!report.is_complete || found == truth.meeting);
                ASSERT_TRUE(report.intersection != Intersection::none || truth.meeting.empty());
                spent += asked->budget.is_spent ? 1 : 0;
                open += report.intersection == Intersection::open ? 1 : 0;
            }
        }
    }
    EXPECT_GT(spent, 100);
    EXPECT_GT(open, 50);
}

TEST(MeshQuery, keeps_the_lowest_of_too_many_meeting_faces_and_contacts)
{
    // Every face of the tool meets every face of the object: 50 x 50 of them.
    TreeRig tool({50, 100, 100});
    TreeRig object({50, 100, 100});
    Random random(75);
    for (std::uint32_t i = 0; i < 50; ++i)
    {
        const float off = 0.001F * static_cast<float>(i);
        tool.put({PrimId{i},
                  FaceId{i},
                  i,
                  0,
                  {Vec3f{-1.0F, off, -1.0F}, Vec3f{1.0F, off, -1.0F}, Vec3f{0.0F, off, 1.0F}}});
        object.put({PrimId{i},
                    FaceId{i},
                    i * 2'654'435'761U,
                    0,
                    {Vec3f{off, -1.0F, -0.5F}, Vec3f{off, 1.0F, -0.5F}, Vec3f{off, 0.0F, 0.9F}}});
    }
    tool.sut->refit();
    object.sut->refit();
    const MeshPlacement place;
    MeshMemory memory;

    const Asked asked = ask(tool, object, place, 0.01, 0.01, memory);

    EXPECT_TRUE(asked.report.is_truncated);
    EXPECT_FALSE(asked.report.is_complete);
    EXPECT_EQ(asked.report.intersection, Intersection::proven);
    ASSERT_EQ(asked.report.meeting.size(), kMaxMeetingFaces);
    for (std::uint32_t i = 0; i < kMaxMeetingFaces; ++i)
    {
        ASSERT_EQ(asked.report.meeting[i], (MeetingFaces{FaceId{i / 50}, FaceId{i % 50}}));
    }
    EXPECT_FALSE(asked.contacts.is_complete);
    ASSERT_EQ(asked.contacts.contacts.size(), kMaxContacts);
    for (std::uint32_t i = 0; i < kMaxContacts; ++i)
    {
        SCOPED_TRACE(i);
        const Contact& contact = asked.contacts.contacts[i];
        EXPECT_EQ(contact.face, FaceId{0});
        EXPECT_EQ(contact.tool_face, FaceId{i});
        EXPECT_EQ(contact.distance_m, 0.0);
        EXPECT_LT((contact.on_tool_m - contact.on_surface_m).norm(), 1e-15);
    }
}

TEST(MeshQuery, keeps_the_nearest_contacts_whatever_met_before)
{
    Random random(89);
    int capacity_exceeded = 0;
    int apart = 0;
    for (int round = 0; round < 120; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        const auto [tool, object] = Meshes(random);
        const MeshPlacement place = random_placement(random);
        const double reach = random.between(0.0, 0.4);
        AllPairs truth(tool.present(), object.present(), place, reach);
        const std::size_t count = std::min<std::size_t>(truth.contacts.size(), kMaxContacts);
        std::ranges::sort(truth.contacts);
        DistanceAnswer first;
        for (const bool exceeded_capacity : {false, true})
        {
            MeshMemory memory{{random.below(10), random.below(10)},
                              exceeded_capacity,
                              random.between(-0.1, 1.0) * reach}; // Any earlier result.
            ContactEnds ends;
            const Asked asked = ask(tool, object, place, reach, reach, memory, kAmple, 0.0, &ends);

            ASSERT_EQ(as_set(asked.report.meeting), truth.meeting) << round;
            ASSERT_TRUE(asked.report.is_complete);
            ASSERT_EQ(asked.contacts.is_complete, truth.contacts.size() <= kMaxContacts) << round;
            ASSERT_EQ(memory.exceeds_capacity, truth.meeting.size() > kMaxContacts) << round;
            ASSERT_EQ(asked.contacts.contacts.size(), count) << round;
            for (std::size_t i = 0; i < count; ++i)
            {
                const Contact& contact = asked.contacts.contacts[i];
                ASSERT_EQ(std::tuple(contact.distance_m, contact.face, contact.tool_face),
                          truth.contacts[i])
                    << round << " " << i;
            }
            ASSERT_EQ(ends.is_empty, count == 0);
            for (const Contact& end : ends.contacts)
            {
                ASSERT_LE(end.distance_m, count == 0 ? 0.0 : reach);
            }
            first = exceeded_capacity ? first : asked.answer;
            ASSERT_EQ(asked.answer.kind, first.kind);
            ASSERT_TRUE(first.kind != AnswerKind::exact || asked.answer.upper_m == first.upper_m);
            ASSERT_EQ(asked.answer.certified_radius_m, first.certified_radius_m);
            ASSERT_EQ(asked.answer.nearest_face, first.nearest_face);
        }
        capacity_exceeded += truth.meeting.size() > kMaxContacts ? 1 : 0;
        apart += truth.meeting.size() < kMaxContacts && truth.contacts.size() > kMaxContacts;
    }
    EXPECT_GT(capacity_exceeded, 2);
    EXPECT_GT(apart, 10);
}

TEST(MeshQuery, ends_where_enough_meets_for_a_tool_that_wants_contacts)
{
    // A mesh on itself, each face ten times: 2,000 pairs meet.
    TreeRig tool({200, 400, 400});
    TreeRig object({200, 400, 400});
    for (std::uint32_t i = 0; i < 200; ++i)
    {
        const float x = static_cast<float>(i / 10);
        for (TreeRig* rig : {&tool, &object})
        {
            rig->put({PrimId{i},
                      FaceId{i},
                      i * 2'654'435'761U,
                      0,
                      {Vec3f{x, 0.0F, 0.0F}, Vec3f{x + 0.5F, 0.0F, 0.0F}, Vec3f{x, 0.5F, 0.0F}}});
        }
    }
    tool.sut->refit();
    object.sut->refit();
    MeshMemory memory;
    for (int again = 0; again < 2; ++again)
    {
        const Asked asked =
            ask_for(kEnoughMeetingFaces, tool, object, MeshPlacement{}, 0.01, 0.01, memory);

        EXPECT_EQ(asked.report.meeting.size(), kEnoughMeetingFaces);
        EXPECT_TRUE(asked.report.is_truncated);
        EXPECT_FALSE(asked.report.is_complete);
        EXPECT_EQ(asked.report.intersection, Intersection::proven);
        EXPECT_EQ(asked.answer.kind, AnswerKind::exact);
        EXPECT_EQ(asked.answer.upper_m, 0.0);
        EXPECT_EQ(asked.contacts.contacts.size(), kMaxContacts);
        EXPECT_FALSE(asked.contacts.is_complete);
        EXPECT_TRUE(memory.exceeds_capacity);
    }
}

TEST(MeshQuery, asks_for_less_of_a_far_distance_after_it_was_cut_and_for_more_again)
{
    constexpr auto kUsual = static_cast<double>(kProofShare);
    Random random(89);
    std::uint32_t cut = 0;
    for (int round = 0; round < 20; ++round)
    {
        const Meshes meshes(random, true, false);
        MeshPlacement place = random_placement(random);
        place.place.translation_m.y() += random.between(5.0, 20.0);
        MeshMemory free_memory;
        const Asked free =
            ask_for(1, meshes.tool, meshes.object, place, 1e-3, -1.0, free_memory, kAmple);
        ASSERT_EQ(free.answer.kind, AnswerKind::separated) << round;
        ASSERT_EQ(free_memory.share, kUsual);
        WalkBudget half = kAmple;
        half.nodes = free.budget.nodes_visited / 2;

        MeshMemory memory;
        double share = kUsual;
        for (int frame = 0; frame < 8; ++frame)
        {
            const Asked sut =
                ask_for(1, meshes.tool, meshes.object, place, 1e-3, -1.0, memory, half);
            ASSERT_LE(sut.answer.lower_m, free.answer.upper_m) << round;
            ASSERT_TRUE(sut.budget.is_spent ? memory.share < 0.1 * kUsual : memory.share >= share)
                << round;
            cut += sut.budget.is_spent ? 1U : 0U;
            share = memory.share;
        }
        AnswerKind kind = AnswerKind::bounded;
        for (int frame = 0; frame < 12; ++frame)
        {
            const Asked sut =
                ask_for(1, meshes.tool, meshes.object, place, 1e-3, -1.0, memory, kAmple);
            ASSERT_LE(sut.answer.lower_m, free.answer.upper_m) << round;
            ASSERT_GE(memory.share, share) << round;
            share = memory.share;
            kind = sut.answer.kind;
        }
        ASSERT_EQ(kind, free.answer.kind) << round;
        ASSERT_EQ(memory.share, kUsual) << round;
    }
    EXPECT_GT(cut, 5U);
}

TEST(MeshQuery, after_it_was_cut_leaves_coarse_faces_to_what_is_certified)
{
    Random random(92);
    std::uint32_t spared = 0;
    for (int round = 0; round < 60; ++round)
    {
        const auto [tool, object] = Meshes(random, false, false, false);
        const MeshPlacement place = lifted_placement(random, 1.5);
        const double reach = random.between(0.05, 0.4);
        const AllPairs truth(tool.present(), object.present(), place, -1.0);
        const double certified = random.between(0.0, std::max(truth.coarse_lower, 0.0));
        MeshMemory free_memory;
        const Asked free = ask_for(1, tool, object, place, reach, -1.0, free_memory);
        MeshMemory memory;
        memory.share = 0.02;
        const Asked sut = ask_for(1, tool, object, place, reach, -1.0, memory, kAmple, certified);
        ASSERT_LE(sut.answer.lower_m, truth.lower) << round;
        if (truth.meeting.empty())
        {
            ASSERT_GE(sut.answer.lower_m, std::min({certified, truth.lower, reach}) - 1e-3)
                << round;
        }
        spared += sut.budget.nodes_visited < free.budget.nodes_visited ? 1U : 0U;
        ASSERT_GT(memory.share, 0.02) << "so that coarse faces are looked at again";
    }
    EXPECT_GT(spared, 20U);
}

TEST(MeshQuery, looks_at_no_coarse_face_where_more_is_certified_than_it_asks_for)
{
    Random random(93);
    std::uint32_t spared = 0;
    for (int round = 0; round < 40; ++round)
    {
        const auto [tool, object] = Meshes(random, false, false, false);
        const MeshPlacement place = lifted_placement(random, 2.5);
        const AllPairs truth(tool.present(), object.present(), place, -1.0);
        if (!(truth.coarse_lower > 0.01) || !truth.meeting.empty())
        {
            continue;
        }
        // The reach is below any face's distance, so the search ends there.
        const double reach = random.between(0.0, 0.9) * truth.coarse_lower;
        MeshMemory free_memory;
        free_memory.share = 0.3;
        MeshMemory memory = free_memory;
        const Asked free = ask_for(1, tool, object, place, reach, -1.0, free_memory);
        const Asked sut =
            ask_for(1, tool, object, place, reach, -1.0, memory, kAmple, truth.coarse_lower);
        ASSERT_LE(sut.answer.lower_m, truth.lower) << round;
        ASSERT_GE(sut.answer.lower_m, std::min(truth.lower, reach) - 1e-3) << round;
        spared += sut.budget.triangles_tested < free.budget.triangles_tested ? 1U : 0U;
    }
    EXPECT_GT(spared, 5U);
}

/// Copy of a rig whose faces are all exact.
TreeRig exact_twin(const TreeRig& rig)
{
    TreeRig twin({300, 600, 600});
    for (ChangedFace face : rig.present())
    {
        face.error = 0;
        twin.put(face);
    }
    twin.sut->refit();
    return twin;
}

TEST(MeshQuery, within_the_tolerance_measures_coarse_faces_like_exact_ones)
{
    constexpr Tolerances kAll{60, 60};
    Random random(95);
    int apart = 0;
    int met = 0;
    for (int round = 0; round < 300; ++round)
    {
        const auto [tool, object] = Meshes(random, false, false, false);
        const TreeRig exact_tool = exact_twin(tool);
        const TreeRig exact_object = exact_twin(object);
        const MeshPlacement place = lifted_placement(random, 1.2);
        const double reach = random.between(0.0, 0.4);
        const std::uint32_t enough = random.one_in(2) ? 1 : kAllMeetingFaces;
        MeshMemory memory;
        MeshMemory twin_memory;
        for (int again = 0; again < 2; ++again) // Once more with what was remembered.
        {
            const Asked sut = ask_for(enough, tool, object, place, reach, reach, memory, kAmple,
                                      0.0, nullptr, kAll);
            const Asked twin =
                ask_for(enough, exact_tool, exact_object, place, reach, reach, twin_memory);
            ASSERT_LE(sut.answer.lower_m, twin.answer.upper_m) << round;
            if (twin.answer.kind != AnswerKind::exact)
            {
                continue;
            }
            ASSERT_LE(sut.answer.lower_m, twin.answer.lower_m) << round;
            ASSERT_GE(sut.answer.upper_m, twin.answer.upper_m) << round;
            const bool do_meet = !twin.report.meeting.empty();
            met += do_meet ? 1 : 0;
            apart += do_meet ? 0 : 1;
            ASSERT_TRUE(is_known(sut.answer.kind)) << round;
            ASSERT_GE(sut.answer.lower_m, twin.answer.lower_m - sut.answer.tolerated_m - 1e-13);
            if (enough != 1 || !do_meet)
            {
                ASSERT_EQ(sut.answer.nearest_face, twin.answer.nearest_face) << round;
                ASSERT_EQ(sut.answer.nearest_point_m, twin.answer.nearest_point_m) << round;
                ASSERT_TRUE(same_contacts(sut.contacts, twin.contacts)) << round;
            }
        }
    }
    EXPECT_GT(met, 20);
    EXPECT_GT(apart, 20);
}

TEST(MeshQuery, an_empty_tree_is_infinitely_far)
{
    TreeRig tool({8, 50, 50});
    TreeRig object({8, 50, 50});
    MeshMemory memory;
    const Asked asked = ask(tool, object, MeshPlacement{}, 0.1, 0.1, memory);
    EXPECT_EQ(asked.answer.kind, AnswerKind::separated);
    EXPECT_EQ(asked.report.intersection, Intersection::none);
    EXPECT_TRUE(asked.contacts.contacts.empty());
}

} // namespace tactus::test
