// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/mesh_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/face_decision.hpp"
#include "rt_core/query/mesh_findings.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/query/pair_walk.hpp"
#include "rt_core/query/placed_blocks.hpp"
#include "rt_core/query/probe.hpp"
#include "rt_core/query/surface_query.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace tactus
{

namespace
{

/// Twice the measuring kernel's error law, in local lengths, rounded up.
constexpr double kSpanError = 4e-15;

/// Ratio of gap to bound above which two blocks are also measured along the direction between them.
constexpr float kFarBlocks = 1.25F;

/// Contacts are expected to be no farther than the last ones plus the tool's motion since. If the
/// motion is unknown, kContactsMoved of the requested distance counts as motion. kContactsAsNear is
/// a margin for rounding.
constexpr double kContactsAsNear = 1.02;
constexpr double kContactsMoved = 0.1;

/// After a query that was cut, the next one requests kMuchLess of the share, at least kLeastShare.
/// After a query that used at most kLittle of its budget, the next one requests 1 / kLittle of the
/// share.
constexpr double kMuchLess = 1.0 / 64.0;
constexpr double kLeastShare = 0x1p-18 * static_cast<double>(kProofShare);
constexpr double kLittle = 0.25;
/// Share below which coarse faces are left to the distance that refinement has certified, and
/// nothing beyond the reach is requested.
constexpr double kShareOfCoarse = kLittle * static_cast<double>(kProofShare);

/// True if the lane of a block still is a face that counts as the surface.
bool is_surface_face(const AbTree& tree, std::uint32_t block, std::uint32_t lane,
                     ErrorCode tolerance) noexcept
{
    return tree.is_block_in_use(block) && lane < kBlockFaces &&
           (tree.block(block).faces & ~lanes_above(tree.side(block), tolerance) & 1U << lane) != 0;
}

/// Error of a face in metres of its model's frame; 0 if it is exact.
double error_of(const AbTree& tree, std::uint32_t block, std::uint32_t lane) noexcept
{
    const BlockSide& side = tree.side(block);
    return (side.coarse >> lane & 1U) != 0
               ? static_cast<double>(error_in_quanta(side.errors[lane])) *
                     static_cast<double>(tree.quantum_m())
               : 0.0;
}

/// The two remembered faces at their present place, and whether they meet.
struct Witness
{
    Triangle tool;
    Triangle triangle;
    Meeting meeting;
    double error_m{0.0}; ///< Error of the pair; 0 if both faces are exact.
    bool do_meet{false};
};

/// Returns the remembered faces; none if one of them is gone or no longer counts as the surface.
std::optional<Witness> find_witness(const MeshQuestion& question, const FacePair& pair,
                                    WalkBudget& budget) noexcept
{
    if (!is_surface_face(question.tool, pair.tool_block, pair.tool_lane, question.tool_tolerance) ||
        !is_surface_face(question.object, pair.block, pair.lane, question.tolerance) ||
        !budget.take_node() || !budget.take_triangles(1))
    {
        return std::nullopt;
    }
    Witness witness;
    witness.tool = placed_triangle(
        to_triangle(block_triangle(question.tool.block(pair.tool_block), pair.tool_lane)),
        question.place);
    witness.triangle = to_triangle(block_triangle(question.object.block(pair.block), pair.lane));
    witness.meeting.tool_prim = question.tool.side(pair.tool_block).prims[pair.tool_lane];
    witness.meeting.prim = question.object.side(pair.block).prims[pair.lane];
    witness.meeting.faces = {question.tool.face_of(witness.meeting.tool_prim),
                             question.object.face_of(witness.meeting.prim)};
    witness.error_m =
        (question.place.place.scale * error_of(question.tool, pair.tool_block, pair.tool_lane) +
         error_of(question.object, pair.block, pair.lane)) *
        kRoundedUp;
    witness.do_meet = meet(witness.tool, witness.triangle);
    return witness;
}

/// Search of one query: finds the near pairs of blocks, and tests their pairs of faces.
class MeshSearch
{
public:
    /// Prepares the search, which ends if `enough` pairs meet.
    MeshSearch(const MeshQuestion& question, Aim aim, std::uint32_t enough, WalkBudget& budget,
               MeshMemory& memory, MeshReport& report, ContactReport* contacts) noexcept
        : question_(question)
        , aim_(aim)
        , budget_(budget)
        , memory_(memory)
        , quantum_m_(static_cast<double>(question.object.quantum_m()))
        , views_(question.tool, question.object, question.place)
        , placed_(question.tool, question.object, question.place, views_, question.tool_tolerance)
        , findings_(question, aim, enough, kSpanError * 2.0 * views_.farthest() * quantum_m_,
                    report, contacts)
        , decision_(question, findings_, memory)
    {
    }

    [[nodiscard]] MeshFindings& findings() noexcept { return findings_; }

    /// Runs the search. If no faces are remembered, `object` gives a first bound on the distance;
    /// null if no distance is requested.
    void run(OtherSurface* object, const std::optional<Witness>& witness) noexcept
    {
        if (question_.tool.root().is_none() || question_.object.root().is_none())
        {
            return;
        }
        const bool is_near = !views_.is_beyond_kernels();
        if (is_near && witness)
        {
            bound_by(*witness);
        }
        // Without a bound, a search for the distance could leave nothing out.
        if (object != nullptr && findings_.bound_m() == kInfinity)
        {
            static_cast<void>(
                findings_.try_bound(object->upper_bound_m(sphere_round(question_.tool.box())) *
                                        question_.place.place.scale * kRoundedUp,
                                    true));
        }
        if (is_near)
        {
            if (memory_.share < kShareOfCoarse && findings_.asks_for_reach_only())
            {
                findings_.leave_open();
            }
            search_all();
            if (findings_.needs_open())
            {
                decision_.bound_queued_open();
            }
            else
            {
                findings_.leave_open();
            }
            decision_.decide_queued();
            decision_.measure_candidates();
        }
        else
        {
            const double gap_m = spheres_gap_m();
            findings_.leave(gap_m > 0.0 ? gap_m : 0.0); // A gap of NaN proves nothing.
        }
        if (!findings_.has_met() && witness && witness->do_meet)
        {
            // The budget was spent before these faces were tested.
            findings_.add_meeting(witness->meeting, witness->error_m);
        }
    }

private:
    /// Gap between the bounding spheres of tool and object, in metres of the object's frame.
    [[nodiscard]] double spheres_gap_m() const noexcept
    {
        const Sphere tool = sphere_round(question_.tool.box());
        const Sphere object = sphere_round(question_.object.box());
        const Vec3 way = question_.place.local_to_world(tool.center) - object.center;
        return way.norm() / kRoundedUp - question_.place.rounding_m(tool.center) -
               (question_.place.place.scale * tool.radius + object.radius) * kRoundedUp;
    }

    /// Bounds the search by the remembered faces.
    void bound_by(const Witness& witness) noexcept
    {
        if (witness.do_meet || aim_ == Aim::meeting)
        {
            static_cast<void>(findings_.try_bound(0.0, witness.error_m == 0.0));
            return;
        }
        decision_.bound_by(witness.tool, witness.triangle);
        test_remembered();
    }

    /// Tests all faces of the remembered blocks first: the nearest face tends to move to a
    /// neighbour.
    void test_remembered() noexcept
    {
        const FacePair& pair = memory_.faces;
        const BlockGeometry& block = question_.object.block(pair.block);
        remembered_.tool = TreeRef::to_block(pair.tool_block);
        remembered_.object = TreeRef::to_block(pair.block);
        remembered_.object_box = AabbVolume::of_vertices(
            question_.object.kernels(), block.coordinates.front().data(), block.vertices);
        const float error = largest_error_quanta(question_.object.side(pair.block));
        remembered_.object_box =
            remembered_.object_box.inflated(error * question_.object.quantum_m());
        static_cast<void>(test_blocks(remembered_));
        decision_.decide_queued();
    }

    void search_all() noexcept
    {
        budget_.spend(WorkCost::walk);
        PairWalk walk(question_.tool, question_.object, views_, budget_,
                      {question_.place, question_.front, question_.tool_tolerance,
                       question_.tolerance, !findings_.needs_open()});
        while (!findings_.is_enough() && !has_stopped_)
        {
            const PairWalk::Item* near =
                walk.next_blocks({bound_quanta(findings_.walked_m()), decision_.find_way(),
                                  !findings_.needs_open()});
            if (near == nullptr)
            {
                break;
            }
            if (near->tool != remembered_.tool || near->object != remembered_.object)
            {
                walk.end_pair(test_blocks(*near));
            }
        }
        findings_.leave(static_cast<double>(walk.end()) * quantum_m_);
    }

    /// Converts a bound to quanta of the object, rounded up, for the kernels.
    [[nodiscard]] float bound_quanta(double bound_m) const noexcept
    {
        const double quanta = bound_m / quantum_m_ * kRoundedUp;
        return quanta < kFarQuanta ? round_up_to_float(quanta)
                                   : std::numeric_limits<float>::infinity();
    }

    /// Ends the search at a pair of blocks that the spent budget left partly untested.
    void stop_at(const PairWalk::Item& item) noexcept
    {
        findings_.leave(static_cast<double>(item.gap) * quantum_m_);
        has_stopped_ = true;
    }

    /// Tests all faces of two blocks and returns a lower bound on their distance. Cheap tests come
    /// first; the object's block is only read if faces of the tool are near its box.
    [[nodiscard]] float test_blocks(const PairWalk::Item& item) noexcept
    {
        FacePair pair{item.tool.index(), item.object.index()};
        const Kernels& kernels = question_.object.kernels();
        const PlacedBlock& tool = placed_.get(pair.tool_block);
        const BlockSide& side = question_.object.side(pair.block);
        const bool takes_open = findings_.needs_open();
        const std::uint32_t open = lanes_above(side, question_.tolerance);
        std::uint32_t tool_lanes = takes_open ? tool.faces : tool.faces & ~tool.open;
        if (!budget_.take_triangles(count_lanes(tool_lanes), WorkCost::block_row))
        {
            stop_at(item);
            return item.gap;
        }
        // The object's box includes its faces' errors, its block does not.
        const float box_bound = bound_of(takes_open && (tool.open | open) != 0);
        const float bound = widened_by_error(box_bound, side, takes_open);
        const auto with_error = [&tool, bound](std::uint32_t lanes)
        { return (bound + tool.largest_error(lanes)) * kSumRoundedUp; };
        const BlockGeometry& block = question_.object.block(pair.block);
        const Aabb& object_box = item.object_box;
        float gap = parted_by(tool, item, block, box_bound, with_error(tool_lanes));
        if (gap > box_bound)
        {
            return gap;
        }
        const std::array<float, 6> box{object_box.low[0],  object_box.low[1],  object_box.low[2],
                                       object_box.high[0], object_box.high[1], object_box.high[2]};
        tool_lanes = kernels.near_rows(tool.rows, box.data(), tool.box.center, tool_lanes,
                                       box_bound, tool.slack(), gap);
        if (tool_lanes == 0)
        {
            return gap;
        }
        const std::uint8_t* corners = block.corners.front().data();
        VertexRows rows; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        const std::uint32_t lanes = kernels.near_block(
            block.coordinates.front().data(), corners, tool.box,
            takes_open ? block.faces : block.faces & ~open, with_error(tool_lanes), rows);
        if (lanes == 0)
        {
            return item.gap;
        }
        std::array<std::uint32_t, kBlockFaces> near; // NOLINT: the kernel fills what is read.
        kernels.near_pairs(rows, corners, lanes, tool.rows, tool_lanes, bound, tool.slack(),
                           decision_.find_way() != nullptr ? decision_.way().data() : nullptr,
                           near.data());
        for (; tool_lanes != 0 && !has_stopped_; tool_lanes &= tool_lanes - 1)
        {
            pair.tool_lane = static_cast<std::uint32_t>(std::countr_zero(tool_lanes));
            for (std::uint32_t left = near[pair.tool_lane]; left != 0; left &= left - 1)
            {
                pair.lane = static_cast<std::uint32_t>(std::countr_zero(left));
                if (!budget_.take_triangles(1, WorkCost::face_pair))
                {
                    stop_at(item);
                    break;
                }
                const bool is_open = ((tool.open >> pair.tool_lane | open >> pair.lane) & 1U) != 0;
                decision_.add(pair, is_open, tool, block, rows, views_.slack());
            }
        }
        return item.gap;
    }

    /// Lower bound on the blocks' distance along one direction, less errors. 0 unless it exceeds
    /// `box_bound`; `bound` is that plus the errors of the object's faces.
    [[nodiscard]] float parted_by(const PlacedBlock& tool, const PairWalk::Item& item,
                                  const BlockGeometry& block, float box_bound, float bound) noexcept
    {
        float gap = 0.0F;
        if (decision_.find_way() != nullptr)
        {
            gap = gap_along_way(tool, item.object_box, block, bound);
        }
        if (!(gap > bound) && item.gap > 0.0F && kFarBlocks * item.gap > box_bound)
        {
            gap = gap_along_own_way(tool, item.object_box, block);
        }
        return gap > bound ? (gap - (bound - box_bound)) / kSumRoundedUp : 0.0F;
    }

    /// Gap of the blocks along the direction between the nearest faces: by the object's box, or by
    /// all vertices of both.
    [[nodiscard]] float gap_along_way(const PlacedBlock& tool, const Aabb& object_box,
                                      const BlockGeometry& block, float bound) noexcept
    {
        const KernelProbe& center = tool.box.center;
        const Vec3f& way = decision_.way();
        const float lowest = placed_.lowest_along(way, decision_.way_number()) - center.slack;
        float highest = 0.0F;
        float size = 0.0F;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float end = way[axis] > 0.0F ? object_box.high[axis] : object_box.low[axis];
            const float at = ((end - center.high[axis]) - center.low[axis]) * center.scale;
            highest += at * way[axis];
            size += std::abs(at);
        }
        const float of_box = lowest - (highest + size * kPairMargin);
        return of_box > bound ? of_box
                              : lowest - question_.object.kernels().highest_along(
                                             block.coordinates.front().data(), block.vertices,
                                             center, way.data());
    }

    /// Gap of the blocks along the direction between their centres, for blocks at another place
    /// that may be as near as the nearest.
    [[nodiscard]] float gap_along_own_way(const PlacedBlock& tool, const Aabb& object_box,
                                          const BlockGeometry& block) const noexcept
    {
        const KernelProbe& center = tool.box.center;
        const Vec3f way = way_between(center, object_box);
        return placed_.lowest_along(way) - center.slack -
               question_.object.kernels().highest_along(block.coordinates.front().data(),
                                                        block.vertices, center, way.data());
    }

    /// Direction from the centre of the object's box to that of the tool's box; not longer than 1.
    [[nodiscard]] static Vec3f way_between(const KernelProbe& center, const Aabb& box) noexcept
    {
        Vec3f way{};
        float length_sq = 0.0F;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float middle = 0.5F * (box.low[axis] + box.high[axis]);
            way[axis] = -(((middle - center.high[axis]) - center.low[axis]) * center.scale);
            length_sq += way[axis] * way[axis];
        }
        const float share = length_sq > 0.0F ? kWayRoundedDown / std::sqrt(length_sq) : 0.0F;
        return {way[0] * share, way[1] * share, way[2] * share};
    }

    /// The bound plus the largest error of a block's visited faces.
    [[nodiscard]] float widened_by_error(float bound, const BlockSide& side,
                                         bool takes_open) const noexcept
    {
        if (!takes_open && question_.tolerance == 0)
        {
            return bound;
        }
        const float largest = largest_error_quanta(side);
        const float error =
            takes_open ? largest : std::min(largest, error_in_quanta(question_.tolerance));
        return (bound + error) * kSumRoundedUp;
    }

    /// Distance within which face pairs of two blocks matter, in quanta of the object, less errors.
    [[nodiscard]] float bound_of(bool has_open) const noexcept
    {
        return bound_quanta(has_open ? findings_.worth_m() : std::max(findings_.measured_m(), 0.0));
    }

    const MeshQuestion& question_;
    Aim aim_;
    WalkBudget& budget_;
    MeshMemory& memory_;
    double quantum_m_;
    MeshViews views_;
    PlacedBlocks placed_;
    MeshFindings findings_;
    FaceDecision decision_;
    bool has_stopped_{false};   ///< True if the budget ended the search early.
    PairWalk::Item remembered_; ///< Blocks of the remembered faces, which are tested first.
};

DistanceAnswer answer_of_meeting(const Witness& witness) noexcept
{
    const ClosestPoints closest = closest_points(witness.tool, witness.triangle, true);
    const bool is_exact = witness.error_m == 0.0;
    DistanceAnswer answer;
    answer.kind = is_exact ? AnswerKind::exact : AnswerKind::within_tolerance;
    answer.lower_m = 0.0;
    answer.upper_m = is_exact ? 0.0 : corners_apart(witness.tool, witness.triangle);
    answer.tolerated_m = witness.error_m;
    answer.tool_point_m = closest.on_shape;
    answer.nearest_face = witness.meeting.faces.face;
    answer.nearest_point_m = closest.on_triangle;
    answer.nearest_feature = closest.feature;
    return answer;
}

/// Reports the remembered faces if they still meet, which makes a search unnecessary. False if they
/// don't.
bool try_report(const std::optional<Witness>& witness, MeshReport& report) noexcept
{
    if (!witness || !witness->do_meet)
    {
        return false;
    }
    const bool is_exact = witness->error_m == 0.0;
    report.intersection = is_exact ? Intersection::proven : Intersection::within_tolerance;
    if (is_exact)
    {
        report.meeting.push_back(witness->meeting.faces);
    }
    return true;
}

/// Does try_report() and sets the distance.
[[gnu::noinline]] bool try_answer(const std::optional<Witness>& witness, DistanceAnswer& answer,
                                  MeshReport& report) noexcept
{
    if (!try_report(witness, report))
    {
        return false;
    }
    answer = answer_of_meeting(*witness);
    report.nearest_tool_face = witness->meeting.faces.tool_face;
    return true;
}

/// Outputs of query_meshes().
struct MeshAnswers
{
    DistanceAnswer& answer;
    MeshReport& report;
    ContactReport& contacts;
};

/// Assumptions that save at least half of a search's time.
struct Guess
{
    bool exceeds_capacity{false};
    double contacts_within_m{kInfinity};
};

/// Searches with a guess. False if the guess was wrong: the answers are then incomplete. Complete
/// answers do not depend on the guess.
[[gnu::noinline]] bool search_meshes(const MeshQuestion& question, const Guess& guess,
                                     OtherSurface& object, MeshMemory& memory,
                                     const std::optional<Witness>& witness,
                                     MeshAnswers& answers) noexcept
{
    MeshSearch search(question, Aim::all, question.enough, object.budget(), memory, answers.report,
                      &answers.contacts);
    if (guess.exceeds_capacity)
    {
        search.findings().expect_exceeded_capacity();
    }
    search.findings().expect_contacts(guess.contacts_within_m);
    search.findings().prove(memory.share);
    search.run(&object, witness);
    memory.exceeds_capacity = search.findings().exceeds_capacity();
    memory.farthest_contact_m = search.findings().farthest_contact_m();
    if (guess.exceeds_capacity ? !memory.exceeds_capacity
                               : !search.findings().has_expected_contacts())
    {
        answers.report.clear();
        answers.contacts.clear();
        return false;
    }
    answers.answer = search.findings().answer();
    search.findings().report_meeting();
    search.findings().report_contacts(answers.answer);
    return true;
}

/// Adapts the share of the next query to the part of the budget that this query used.
class ShareRule
{
public:
    explicit ShareRule(const WalkBudget& budget) noexcept
        : budget_(budget)
        , used_(budget.frame != nullptr ? budget.frame->used() : 0)
        , left_(budget.frame != nullptr ? budget.frame->left() : 0)
    {
    }

    void fit(double& share) const noexcept
    {
        if (budget_.is_spent)
        {
            share = std::max(kMuchLess * share, kLeastShare);
        }
        else if (is_little(budget_.nodes_visited, budget_.nodes) &&
                 is_little(budget_.triangles_tested, budget_.triangles) &&
                 (budget_.frame == nullptr || is_little(budget_.frame->used() - used_, left_)))
        {
            share = std::min(share / kLittle, static_cast<double>(kProofShare));
        }
    }

private:
    [[nodiscard]] static bool is_little(std::uint32_t used, std::uint32_t most) noexcept
    {
        return static_cast<double>(used) <= kLittle * static_cast<double>(most);
    }

    const WalkBudget& budget_;
    std::uint32_t used_; ///< Work of the frame before the query.
    std::uint32_t left_;
};

/// Motion of the tool since the last query; kContactsMoved of the contact distance if unknown.
double moved_m(const MeshQuestion& question) noexcept
{
    const double motion_m = question.front != nullptr
                                ? motion_between(question.front->place, question.place,
                                                 sphere_round(question.tool.box()))
                                : kInfinity;
    return std::isfinite(motion_m) ? motion_m : kContactsMoved * question.contact_m;
}

} // namespace

void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report, ContactReport& contacts) noexcept
{
    report.clear();
    contacts.clear();
    const ShareRule shares(object.budget());
    const std::optional<Witness> witness = find_witness(question, memory.faces, object.budget());
    if (question.enough == 1 && try_answer(witness, answer, report))
    {
        return;
    }
    MeshAnswers answers{answer, report, contacts};
    const double farthest_m = memory.farthest_contact_m;
    const bool are_asked = question.contact_m >= 0.0;
    const double within_m = kContactsAsNear * (farthest_m + moved_m(question));
    const bool is_guessed =
        are_asked && ((memory.exceeds_capacity &&
                       search_meshes(question, {true}, object, memory, witness, answers)) ||
                      (farthest_m >= 0.0 && search_meshes(question, {false, within_m}, object,
                                                          memory, witness, answers)));
    if (!is_guessed)
    {
        search_meshes(question, {}, object, memory, witness, answers);
    }
    shares.fit(memory.share);
}

void find_nearest_faces(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                        DistanceAnswer& answer, MeshReport& report) noexcept
{
    report.clear();
    const std::optional<Witness> witness = find_witness(question, memory.faces, object.budget());
    TACTUS_ASSERT(!question.is_tolerant());
    if (try_answer(witness, answer, report))
    {
        return;
    }
    MeshSearch search(question, Aim::nearest, 1, object.budget(), memory, report, nullptr);
    search.run(&object, witness);
    answer = search.findings().answer();
    search.findings().report_meeting();
    search.findings().report_nearest(answer);
}

void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept
{
    TACTUS_ASSERT(!question.is_tolerant());
    report.clear();
    if (enough == 1 && try_report(find_witness(question, memory.faces, budget), report))
    {
        return;
    }
    MeshSearch search(question, Aim::meeting, enough, budget, memory, report, nullptr);
    search.run(nullptr, std::nullopt);
    search.findings().report_meeting();
}

} // namespace tactus
