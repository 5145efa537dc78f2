// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/mesh_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/geometry/shared_features.hpp"
#include "rt_core/geometry/triangle_triangle.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/contact_set.hpp"
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
#include <tuple>
#include <utility>

namespace tactus
{

namespace
{

/// Twice the kernel's error law and more.
constexpr double kSpanError = 4e-15;

/// A face of either model, in the object's frame.
struct MeshFace
{
    Triangle triangle;
    double error_m{0.0};
};

/// Exact faces that are to be measured, unless others turn out to be nearer.
struct Candidate
{
    FacePair pair;
    float gap; ///< They are at least this far apart, in quanta.
};
constexpr std::size_t kMaxCandidates = 192;

/// Exact faces that share a point.
struct Meeting
{
    MeetingFaces faces;
    PrimId tool_prim{};
    PrimId prim{};
};

/// In the order of contacts.
bool comes_before(const MeetingFaces& a, const MeetingFaces& b) noexcept
{
    return std::tie(a.face, a.tool_face) < std::tie(b.face, b.tool_face);
}

Triangle triangle_of(const AbTree& tree, PrimId prim) noexcept
{
    const std::uint32_t leaf = tree.leaf_of(prim);
    TACTUS_ASSERT(leaf != AbTree::kNoLeaf);
    return to_triangle(block_triangle(tree.block(leaf / kBlockFaces), leaf % kBlockFaces));
}

Triangle placed_triangle(const Triangle& there, const MeshPlacement& place) noexcept
{
    return {place.to_there(there[0]), place.to_there(there[1]), place.to_there(there[2])};
}

/// Whether a lane of a block is an exact face now.
bool is_exact_face(const AbTree& tree, std::uint32_t block, std::uint32_t lane) noexcept
{
    return tree.is_block_in_use(block) && lane < kBlockFaces &&
           (tree.block(block).faces & ~tree.side(block).coarse & 1U << lane) != 0;
}

/// Whether any face of a tree is not exact.
bool has_coarse(const AbTree& tree) noexcept
{
    const TreeRef root = tree.root();
    return !root.is_none() &&
           (root.is_block() ? tree.side(root.index()).coarse : tree.node(root.index()).coarse) != 0;
}

/// The faces that are remembered, where they are now.
struct Witness
{
    Triangle tool;
    Triangle triangle;
    Meeting meeting;
    bool do_meet{false};
};

/// None when one of them is gone or no longer exact.
std::optional<Witness> find_witness(const MeshQuestion& question, const FacePair& pair,
                                    WalkBudget& budget) noexcept
{
    if (!is_exact_face(question.tool, pair.tool_block, pair.tool_lane) ||
        !is_exact_face(question.object, pair.block, pair.lane) || !budget.take_node() ||
        !budget.take_triangles(1))
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
    witness.do_meet = meet(witness.tool, witness.triangle);
    return witness;
}

/// What a search is for.
enum class Aim : std::uint8_t
{
    all,     ///< Distance within the reach, what meets, contacts.
    nearest, ///< The distance.
    meeting, ///< What meets, which needs no measuring.
};
constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

/// Blocks that are apart by more than what counts over this are measured along their own way, too.
constexpr float kFarBlocks = 1.25F;

/// Contacts as near as this times the farthest that is kept are asked for their ends.
constexpr double kEndsAsNear = 1.1;

/// One query: the pairs of blocks that are near, and of each the pairs of faces.
class MeshSearch
{
public:
    /// Ends when `enough` pairs meet.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): distances_ are written first.
    MeshSearch(const MeshQuestion& question, Aim aim, std::uint32_t enough, WalkBudget& budget,
               MeshMemory& memory, MeshReport& report, ContactReport* contacts) noexcept
        : question_(question)
        , aim_(aim)
        , enough_(enough)
        , reach_m_(aim == Aim::nearest ? kInfinity : question.reach_m)
        , budget_(budget)
        , memory_(memory)
        , report_(report)
        , contacts_(contacts)
        , tool_quantum_m_(static_cast<double>(question.tool.quantum_m()) *
                          question.place.place.scale)
        , quantum_m_(static_cast<double>(question.object.quantum_m()))
        , views_(question.tool, question.object, question.place)
        , placed_(question.tool, question.object, question.place, views_)
        , doubt_m_(kSpanError * 2.0 * views_.farthest() * quantum_m_)
        , has_coarse_(has_coarse(question.tool) || has_coarse(question.object))
    {
        TACTUS_ASSERT(question.reach_m >= 0.0);
        TACTUS_ASSERT(enough > 0);
        TACTUS_ASSERT(aim != Aim::all || contacts != nullptr);
    }

    /// Contacts that are apart are not looked for: good only where is_crowded() in the end.
    void expect_crowd() noexcept { expects_crowd_ = true; }
    /// What meets leaves no room for other contacts.
    [[nodiscard]] bool is_crowded() const noexcept
    {
        return touching_.size() == kMaxContacts && found_ > kMaxContacts;
    }

    /// `object` is asked how far away it is where nothing is remembered; null when that is not
    /// wanted.
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
        // Where a distance is wanted there has to be a bound, before anything can be left out.
        if (object != nullptr && bound_m_ == kInfinity)
        {
            bound_m_ = object->upper_bound_m(ball_round(question_.tool.box())) *
                       question_.place.place.scale * kRoundedUp;
        }
        if (is_near)
        {
            search_all();
            if (needs_coarse())
            {
                bound_queued_coarse();
            }
            else if (has_coarse_)
            {
                leave(question_.certified_m);
            }
            decide_queued();
            measure_candidates();
        }
        else
        {
            const double gap_m = balls_gap_m();
            leave(gap_m > 0.0 ? gap_m : 0.0); // Not a number: nothing is known.
        }
        if (found_ == 0 && witness && witness->do_meet)
        {
            add_meeting(witness->meeting); // The budget was spent before.
        }
    }

    [[nodiscard]] DistanceAnswer answer() noexcept
    {
        Findings found;
        found.exact_lower_m = exact_lower_m_;
        found.upper_m = std::min(upper_m_, bound_m_);
        found.open_m = is_all_there() ? open_m_ : std::min(open_m_, 0.0);
        if (enough_ == 1 || is_enough())
        {
            found.open_m = std::max(found.open_m, 0.0); // Nothing is nearer than what meets.
        }
        found.pruned_m = found.upper_m > reach_m_ ? worth_m() : kInfinity;
        found.dropped_m = kInfinity;
        DistanceAnswer answer = answer_from(found, reach_m_);
        if (is_nearest_proven(found))
        {
            if (!touching_.empty())
            {
                nearest_faces_ = touching_[0].faces;
                nearest_ = closest_of(touching_[0]);
            }
            answer.tool_point_m = nearest_.on_shape;
            answer.nearest_face = nearest_faces_.face;
            answer.nearest_point_m = nearest_.on_triangle;
            answer.nearest_feature = nearest_.feature;
        }
        return answer;
    }

    /// What meets, sorted.
    void report_meeting() noexcept
    {
        TACTUS_ASSERT(report_.meeting.size() <= found_);
        if (!report_.is_truncated)
        {
            std::ranges::make_heap(report_.meeting);
        }
        std::ranges::sort_heap(report_.meeting);
        const bool is_all_seen = is_all_there() && open_m_ > 0.0;
        report_.is_truncated = report_.is_truncated || (is_enough() && enough_ > 1);
        report_.is_complete = is_all_seen && !report_.is_truncated && !is_enough();
        report_.intersection = !report_.meeting.empty() ? Intersection::proven
                               : is_all_seen            ? Intersection::none
                                                        : Intersection::open;
    }

    /// The tool's face of the nearest pair.
    void report_nearest(const DistanceAnswer& answer) noexcept
    {
        report_.nearest_tool_face =
            answer.nearest_face.is_none() ? FaceId{} : nearest_faces_.tool_face;
    }

    /// The contacts in order, and the tool's face of the nearest pair.
    void report_contacts(const DistanceAnswer& answer) noexcept
    {
        report_nearest(answer);
        if (question_.contact_m < 0.0)
        {
            return;
        }
        if (is_crowded()) // However many were found before.
        {
            contacts_->contacts.clear();
            drop_ends();
        }
        for (const Meeting& meeting : touching_)
        {
            keep_contact(meeting.faces, object_triangle(meeting.prim), closest_of(meeting));
        }
        contacts_->is_complete =
            !has_dropped_ && (answer.certified_radius_m >= question_.contact_m ||
                              answer.lower_m > question_.contact_m);
    }

private:
    void drop_ends() const noexcept
    {
        if (question_.ends != nullptr)
        {
            question_.ends->is_empty = true;
        }
    }
    [[nodiscard]] bool is_all_there() const noexcept
    {
        return question_.tool.is_complete() && question_.object.is_complete();
    }

    /// What is farther changes nothing; never grows.
    [[nodiscard]] double worth_m() const noexcept
    {
        switch (aim_)
        {
        case Aim::all:
            return std::max(reach_m_, static_cast<double>(kProofShare) * bound_m_);
        case Aim::nearest:
            return bound_m_ + doubt_m_;
        case Aim::meeting:
            break;
        }
        return 0.0;
    }
    /// Exact pairs that are farther apart need no measuring; negative when none does.
    [[nodiscard]] double measured_m() const noexcept
    {
        if (aim_ == Aim::meeting)
        {
            return -1.0;
        }
        const double nearest_m = bound_m_ > 0.0 ? bound_m_ + doubt_m_ : -1.0;
        return std::min(worth_m(), std::max(asked_contact_m(), nearest_m));
    }
    /// Whether coarse faces may be near enough to change something; where they aren't they never
    /// will be, as what matters never grows.
    [[nodiscard]] bool needs_coarse() const noexcept
    {
        const double matters_m = aim_ == Aim::meeting ? 0.0 : std::max(worth_m(), bound_m_);
        return has_coarse_ && !is_left_open() && !(question_.certified_m > matters_m * kRoundedUp);
    }
    /// A coarse face may meet the other surface, and the two are in reach: no other tells more.
    [[nodiscard]] bool is_left_open() const noexcept
    {
        return open_m_ <= 0.0 &&
               (aim_ == Aim::meeting || (aim_ == Aim::all && bound_m_ <= reach_m_));
    }
    /// What is farther apart in space needs no look, whether exact or not.
    [[nodiscard]] double walked_m() const noexcept
    {
        return needs_coarse() ? worth_m() : std::max(measured_m(), 0.0);
    }
    /// Something was not looked at that is at least this far away.
    void leave(double gap_m) noexcept { open_m_ = std::min(open_m_, gap_m); }
    [[nodiscard]] bool is_enough() const noexcept { return found_ >= enough_; }

    /// Of the tool's ball and the object's.
    [[nodiscard]] double balls_gap_m() const noexcept
    {
        const Ball tool = ball_round(question_.tool.box());
        const Ball object = ball_round(question_.object.box());
        const Vec3 way = question_.place.to_there(tool.center) - object.center;
        return way.norm() / kRoundedUp - question_.place.rounding_m(tool.center) -
               (question_.place.place.scale * tool.radius + object.radius) * kRoundedUp;
    }

    /// What is remembered leaves little to look at.
    void bound_by(const Witness& witness) noexcept
    {
        if (witness.do_meet || aim_ == Aim::meeting)
        {
            bound_m_ = 0.0;
            return;
        }
        queue_.add(memory_.faces, witness.tool, witness.triangle, quantum_m_);
        question_.object.kernels().pair_distances(queue_.rows(), 1, distances_);
        queue_.clear();
        take_bound(0, memory_.faces);
        test_remembered();
    }

    /// All faces of the blocks of those that are remembered: the nearest moves to a face beside.
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
        test_blocks(remembered_);
        decide_queued();
    }

    void search_all() noexcept
    {
        PairWalk walk(question_.tool, question_.object, views_, budget_);
        while (!is_enough() && !has_stopped_)
        {
            const PairWalk::Item* near = walk.next_blocks(
                {bound_quanta(walked_m()), way_number_ != 0 ? &way_ : nullptr, !needs_coarse()});
            if (near == nullptr)
            {
                break;
            }
            if (near->tool != remembered_.tool || near->object != remembered_.object)
            {
                test_blocks(*near);
            }
        }
        for (const PairWalk::Item& item : walk.left())
        {
            leave(static_cast<double>(item.gap) * quantum_m_);
        }
    }

    /// For the kernels.
    [[nodiscard]] float bound_quanta(double bound_m) const noexcept
    {
        const double quanta = bound_m / quantum_m_ * kRoundedUp;
        return quanta < kFarQuanta ? round_up_to_float(quanta)
                                   : std::numeric_limits<float>::infinity();
    }

    /// The budget is spent; of these blocks not all was looked at.
    void stop_at(const PairWalk::Item& item) noexcept
    {
        leave(static_cast<double>(item.gap) * quantum_m_);
        has_stopped_ = true;
    }

    /// The cheapest test first; the object's block is not read before the tool's faces are near its
    /// box.
    void test_blocks(const PairWalk::Item& item) noexcept
    {
        FacePair pair{item.tool.index(), item.object.index()};
        const Kernels& kernels = question_.object.kernels();
        const PlacedBlock& tool = placed_.get(pair.tool_block);
        const BlockSide& side = question_.object.side(pair.block);
        const bool takes_coarse = needs_coarse();
        std::uint32_t tool_lanes = takes_coarse ? tool.faces : tool.faces & ~tool.coarse;
        if (!budget_.take_triangles(static_cast<std::uint32_t>(std::popcount(tool_lanes))))
        {
            stop_at(item);
            return;
        }
        // Errors are in the box, and not in the block.
        const float box_bound = bound_of(tool, side, takes_coarse);
        const float bound =
            takes_coarse ? (box_bound + largest_error_quanta(side)) * kSumRoundedUp : box_bound;
        const auto with_error = [&tool, bound](std::uint32_t lanes)
        { return (bound + tool.largest_error(lanes)) * kSumRoundedUp; };
        const BlockGeometry& block = question_.object.block(pair.block);
        const Aabb& object_box = item.object_box;
        if (are_parted(tool, item, block, box_bound, with_error(tool_lanes)))
        {
            return;
        }
        const std::array<float, 6> box{object_box.low[0],  object_box.low[1],  object_box.low[2],
                                       object_box.high[0], object_box.high[1], object_box.high[2]};
        tool_lanes = kernels.near_rows(tool.rows, box.data(), tool.box.center, tool_lanes,
                                       box_bound, tool.slack());
        if (tool_lanes == 0)
        {
            return;
        }
        const std::uint8_t* corners = block.corners.front().data();
        VertexRows rows; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        const std::uint32_t lanes = kernels.near_block(
            block.coordinates.front().data(), corners, tool.box,
            takes_coarse ? block.faces : block.faces & ~side.coarse, with_error(tool_lanes), rows);
        if (lanes == 0)
        {
            return;
        }
        std::array<std::uint32_t, kBlockFaces> near; // NOLINT: the kernel fills what is read.
        kernels.near_pairs(rows, corners, lanes, tool.rows, tool_lanes, bound, tool.slack(),
                           way_number_ != 0 ? way_.data() : nullptr, near.data());
        for (; tool_lanes != 0 && !has_stopped_; tool_lanes &= tool_lanes - 1)
        {
            pair.tool_lane = static_cast<std::uint32_t>(std::countr_zero(tool_lanes));
            for (std::uint32_t left = near[pair.tool_lane]; left != 0; left &= left - 1)
            {
                pair.lane = static_cast<std::uint32_t>(std::countr_zero(left));
                if (!budget_.take_triangles(1))
                {
                    stop_at(item);
                    break;
                }
                const bool is_coarse =
                    ((tool.coarse >> pair.tool_lane | side.coarse >> pair.lane) & 1U) != 0;
                FacePairQueue& queue = is_coarse ? coarse_queue_ : queue_;
                queue.add(pair, tool, block, rows, views_.slack());
                if (queue.is_full())
                {
                    is_coarse ? bound_queued_coarse() : decide_queued();
                }
            }
        }
    }

    /// Along some way two blocks are farther apart than `bound`.
    [[nodiscard]] bool are_parted(const PlacedBlock& tool, const PairWalk::Item& item,
                                  const BlockGeometry& block, float box_bound, float bound) noexcept
    {
        const bool are_far = item.gap > 0.0F && kFarBlocks * item.gap > box_bound;
        return (way_number_ != 0 && are_parted_along_way(tool, item.object_box, block, bound)) ||
               (are_far && are_parted_along_own_way(tool, item.object_box, block, bound));
    }

    /// Along the way between the nearest two blocks are farther apart than they may be: by the
    /// object's box, or by all vertices of both.
    [[nodiscard]] bool are_parted_along_way(const PlacedBlock& tool, const Aabb& object_box,
                                            const BlockGeometry& block, float bound) noexcept
    {
        const KernelProbe& center = tool.box.center;
        const float lowest = placed_.lowest_along(way_, way_number_) - center.slack - bound;
        float highest = 0.0F;
        float size = 0.0F;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float end = way_[axis] > 0.0F ? object_box.high[axis] : object_box.low[axis];
            const float at = ((end - center.high[axis]) - center.low[axis]) * center.scale;
            highest += at * way_[axis];
            size += std::abs(at);
        }
        return lowest > highest + size * kPairMargin ||
               lowest > question_.object.kernels().highest_along(
                            block.coordinates.front().data(), block.vertices, center, way_.data());
    }

    /// The same along the way between the two: elsewhere something may be as near as the nearest.
    [[nodiscard]] bool are_parted_along_own_way(const PlacedBlock& tool, const Aabb& object_box,
                                                const BlockGeometry& block,
                                                float bound) const noexcept
    {
        const KernelProbe& center = tool.box.center;
        const Vec3f way = way_between(center, object_box);
        return placed_.lowest_along(way) - center.slack - bound >
               question_.object.kernels().highest_along(block.coordinates.front().data(),
                                                        block.vertices, center, way.data());
    }

    /// From the object's box to the tool's, as the centres lie; not longer than 1.
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
        const float share = length_sq > 0.0F ? (1.0F - 0x1p-20F) / std::sqrt(length_sq) : 0.0F;
        return {way[0] * share, way[1] * share, way[2] * share};
    }

    /// In quanta, what pairs of faces of two blocks have to be within, errors taken off.
    [[nodiscard]] float bound_of(const PlacedBlock& tool, const BlockSide& side,
                                 bool takes_coarse) const noexcept
    {
        const bool has_coarse = takes_coarse && (tool.coarse | side.coarse) != 0;
        return bound_quanta(has_coarse ? worth_m() : std::max(measured_m(), 0.0));
    }

    /// Of queued pairs of which a face is coarse: those that may lower a bound, in double
    /// precision.
    void bound_queued_coarse() noexcept
    {
        const std::uint32_t count = coarse_queue_.size();
        if (count == 0)
        {
            return;
        }
        question_.object.kernels().pair_distances(coarse_queue_.rows(), count, distances_);
        for (std::uint32_t lane = 0; lane < count; ++lane)
        {
            const FacePair& pair = coarse_queue_[lane];
            const double gap_m = static_cast<double>(distances_.lower[lane]) * quantum_m_;
            const double lower_m = gap_m - (tool_error_m(pair) + object_error_m(pair)) * kRoundedUp;
            if (lower_m > worth_m() || (lower_m >= open_m_ && gap_m >= bound_m_))
            {
                continue;
            }
            const MeshFace tool{tool_triangle(pair), tool_error_m(pair)};
            const MeshFace face{object_triangle(pair), object_error_m(pair)};
            if (lower_m < open_m_)
            {
                leave_coarse(tool, face);
            }
            if (gap_m < bound_m_)
            {
                bound_by_corners(tool, face);
            }
        }
        coarse_queue_.clear();
    }

    /// Signs in single precision, and exactly where they are in doubt.
    void decide_queued() noexcept
    {
        const std::uint32_t count = queue_.size();
        if (count == 0)
        {
            return;
        }
        const PairSides sides = question_.object.kernels().decide_pairs(queue_.rows(), count);
        std::uint32_t apart = sides.apart;
        for (std::uint32_t left = ((1U << count) - 1) & ~sides.apart; left != 0 && !is_enough();
             left &= left - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
            const FacePair& pair = queue_[lane];
            if ((sides.meet >> lane & 1U) != 0 || do_meet(pair))
            {
                memory_.faces = pair;
                add_meeting(meeting_of(pair));
            }
            else
            {
                apart |= 1U << lane;
            }
        }
        if (apart != 0 && measured_m() >= 0.0)
        {
            bound_distances(apart, count);
        }
        queue_.clear();
    }

    [[nodiscard]] bool do_meet(const FacePair& pair) const noexcept
    {
        return meet(tool_triangle(pair), object_triangle(pair));
    }

    [[nodiscard]] Meeting meeting_of(const FacePair& pair) const noexcept
    {
        const PrimId tool_prim = question_.tool.side(pair.tool_block).prims[pair.tool_lane];
        const PrimId prim = question_.object.side(pair.block).prims[pair.lane];
        return {
            {question_.tool.face_of(tool_prim), question_.object.face_of(prim)}, tool_prim, prim};
    }

    /// Of queued pairs that don't meet.
    void bound_distances(std::uint32_t apart, std::uint32_t count) noexcept
    {
        question_.object.kernels().pair_distances(queue_.rows(), count, distances_);
        for (; apart != 0; apart &= apart - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(apart));
            const float gap = distances_.lower[lane];
            if (static_cast<double>(gap) * quantum_m_ > measured_m())
            {
                continue;
            }
            const Candidate candidate{queue_[lane], gap};
            take_bound(lane, candidate.pair);
            count_contact(distances_.upper[lane]);
            if (candidates_.full())
            {
                make_room();
            }
            candidates_.push_back(candidate);
        }
    }

    /// Candidates go that others have turned out to be nearer than, and those that could only be
    /// ends but for one of each direction; where too few do, all are measured.
    void make_room() noexcept
    {
        const double contact_m = contact_zone_m();
        const FarthestEnds farthest = farthest_ends();
        std::size_t left = 0;
        for (std::size_t i = 0; i < candidates_.size(); ++i)
        {
            const bool stays = gap_of(candidates_[i]) <= contact_m ||
                               std::ranges::find(farthest, i) != farthest.end();
            candidates_[left] = candidates_[i];
            left += stays ? 1U : 0U;
        }
        while (candidates_.size() > left)
        {
            candidates_.pop_back();
        }
        if (4 * left > 3 * kMaxCandidates)
        {
            measure_candidates();
        }
    }

    /// Of a pair that is no farther apart. Of more contacts than there is room for those are not
    /// kept that all of `nearest_contacts_` are nearer than: the search need not go there.
    void count_contact(float upper) noexcept
    {
        if (aim_ != Aim::all || static_cast<double>(upper) * quantum_m_ > question_.contact_m)
        {
            return;
        }
        if (nearest_contacts_.full())
        {
            if (upper >= nearest_contacts_[0])
            {
                return;
            }
            std::ranges::pop_heap(nearest_contacts_);
            nearest_contacts_.pop_back();
        }
        nearest_contacts_.push_back(upper);
        std::ranges::push_heap(nearest_contacts_);
    }

    /// What is farther than this pair, in space or along the way between the two, is not the
    /// nearest.
    void take_bound(std::uint32_t lane, const FacePair& pair) noexcept
    {
        const double upper_m =
            static_cast<double>(distances_.upper[lane]) * quantum_m_ * kRoundedUp;
        if (!(upper_m < bound_m_))
        {
            return;
        }
        bound_m_ = upper_m;
        memory_.faces = pair;
        ++way_number_;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            way_[axis] = distances_.way[axis][lane] * (1.0F - 0x1p-20F); // Not longer than 1.
        }
    }

    /// In double precision, those that may be the nearest or contacts. The nearest come first: they
    /// leave the least to measure.
    void measure_candidates() noexcept
    {
        const auto is_farther = [](const Candidate& a, const Candidate& b)
        { return a.gap > b.gap; };
        std::ranges::make_heap(candidates_, is_farther);
        while (!candidates_.empty())
        {
            const double gap_m = gap_of(candidates_[0]);
            if (gap_m > measured_m())
            {
                break;
            }
            if (gap_m > contact_zone_m())
            {
                measure_ends();
                break;
            }
            std::ranges::pop_heap(candidates_, is_farther);
            measure(candidates_.pop_back().pair);
        }
        candidates_.clear();
    }

    /// Farther pairs are neither the nearest nor contacts that are kept, and could only be ends.
    [[nodiscard]] double contact_zone_m() const noexcept
    {
        return question_.ends != nullptr
                   ? std::min(measured_m(), std::max(kept_contact_m(), bound_m_ + doubt_m_))
                   : measured_m();
    }
    [[nodiscard]] double gap_of(const Candidate& candidate) const noexcept
    {
        return static_cast<double>(candidate.gap) * quantum_m_;
    }

    void measure(const FacePair& pair) noexcept
    {
        const Triangle triangle = object_triangle(pair);
        add_apart(meeting_of(pair).faces, triangle,
                  shared_.closest_points(tool_triangle(pair), triangle));
    }

    /// Of each direction the candidate, by its place, that may be farthest of those that could
    /// only be ends; kMaxCandidates where none may be farther than what is known.
    using FarthestEnds = std::array<std::size_t, kContactDirections>;
    [[nodiscard]] FarthestEnds farthest_ends() const noexcept
    {
        FarthestEnds farthest{};
        farthest.fill(kMaxCandidates);
        if (question_.ends == nullptr)
        {
            return farthest;
        }
        const double contact_m = contact_zone_m();
        const double asked_m = measured_m();
        EndReaches most_m = question_.ends->reaches_m;
        if (question_.ends->is_empty)
        {
            most_m.fill(-kInfinity);
        }
        for (std::size_t i = 0; i < candidates_.size(); ++i)
        {
            const double gap_m = gap_of(candidates_[i]);
            if (gap_m <= contact_m || gap_m > asked_m)
            {
                continue;
            }
            const FacePair& pair = candidates_[i].pair;
            const EndReaches reaches_m = most_end_reaches(object_triangle(pair), gap_m);
            const bool is_any = is_farther_in_any(reaches_m, most_m);
            for (std::size_t end = 0; is_any && end < kContactDirections; ++end)
            {
                std::size_t& place = farthest[end];
                if (reaches_m[end] > most_m[end] ||
                    (reaches_m[end] == most_m[end] && place != kMaxCandidates &&
                     comes_before(meeting_of(pair).faces,
                                  meeting_of(candidates_[place].pair).faces)))
                {
                    place = i;
                    most_m[end] = reaches_m[end];
                }
            }
        }
        return farthest;
    }

    /// One of each direction: what else lies near the end of what the tool lies on is as good.
    void measure_ends() noexcept
    {
        const FarthestEnds farthest = farthest_ends();
        for (const std::size_t& place : farthest)
        {
            const bool is_first = std::find(farthest.begin(), &place, place) == &place;
            if (is_first && place != kMaxCandidates)
            {
                measure(candidates_[place].pair);
            }
        }
    }

    [[nodiscard]] double tool_error_m(const FacePair& pair) const noexcept
    {
        const ErrorCode error = question_.tool.side(pair.tool_block).errors[pair.tool_lane];
        return static_cast<double>(error_in_quanta(error)) * tool_quantum_m_ * kRoundedUp;
    }
    [[nodiscard]] double object_error_m(const FacePair& pair) const noexcept
    {
        const ErrorCode error = question_.object.side(pair.block).errors[pair.lane];
        return static_cast<double>(error_in_quanta(error)) * quantum_m_;
    }
    [[nodiscard]] Triangle tool_triangle(const FacePair& pair) const noexcept
    {
        return placed_triangle(
            to_triangle(block_triangle(question_.tool.block(pair.tool_block), pair.tool_lane)),
            question_.place);
    }
    [[nodiscard]] Triangle object_triangle(const FacePair& pair) const noexcept
    {
        return to_triangle(block_triangle(question_.object.block(pair.block), pair.lane));
    }

    /// No contact that is farther apart is kept; negative when none is.
    [[nodiscard]] double kept_contact_m() const noexcept
    {
        if (aim_ != Aim::all || expects_crowd_)
        {
            return -1.0;
        }
        // What meets comes before all that is apart.
        const ContactSet& apart = contacts_->contacts;
        const std::size_t room = kMaxContacts - touching_.size();
        double farthest_m = question_.contact_m;
        if (nearest_contacts_.full())
        {
            farthest_m = std::min(farthest_m, static_cast<double>(nearest_contacts_[0]) *
                                                  quantum_m_ * kRoundedUp);
        }
        if (!has_dropped_ && apart.size() <= room)
        {
            return farthest_m;
        }
        return room == 0 ? -1.0 : std::min(apart[room - 1].distance_m, farthest_m);
    }
    /// Nor does it count among the ends.
    [[nodiscard]] double asked_contact_m() const noexcept
    {
        const double as_near = question_.ends != nullptr ? kEndsAsNear : 1.0;
        return std::min(as_near * kept_contact_m(), question_.contact_m);
    }

    void leave_coarse(const MeshFace& tool_face, const MeshFace& face) noexcept
    {
        const ClosestPoints closest = closest_points(tool_face.triangle, face.triangle);
        leave(closest.distance - closest.distance_error - tool_face.error_m - face.error_m);
    }

    /// Those of coarse faces are original vertices.
    void bound_by_corners(const MeshFace& tool_face, const MeshFace& face) noexcept
    {
        double nearest_sq = kInfinity;
        for (const Vec3& tool_corner : tool_face.triangle)
        {
            for (const Vec3& corner : face.triangle)
            {
                nearest_sq = std::min(nearest_sq, (tool_corner - corner).squaredNorm());
            }
        }
        take_upper(std::sqrt(nearest_sq) * kRoundedUp);
    }

    void take_upper(double upper_m) noexcept
    {
        upper_m_ = std::min(upper_m_, upper_m);
        bound_m_ = std::min(bound_m_, upper_m_);
    }

    void add_apart(const MeetingFaces& faces, const Triangle& triangle,
                   const ClosestPoints& closest) noexcept
    {
        exact_lower_m_ =
            std::min(exact_lower_m_, std::max(0.0, closest.distance - closest.distance_error));
        take_upper(closest.distance + closest.distance_error);
        if (aim_ == Aim::all && !expects_crowd_ && closest.distance <= question_.contact_m)
        {
            keep_contact(faces, triangle, closest);
        }
        if (!has_nearest_ || closest.distance < nearest_.distance ||
            (closest.distance == nearest_.distance && comes_before(faces, nearest_faces_)))
        {
            has_nearest_ = true;
            nearest_ = closest;
            nearest_faces_ = faces;
        }
    }

    void add_meeting(const Meeting& meeting) noexcept
    {
        exact_lower_m_ = 0.0;
        take_upper(0.0);
        ++found_;
        keep_lowest(meeting.faces);
        if (aim_ != Aim::meeting)
        {
            keep_touching(meeting);
        }
    }

    /// In any order until there are too many, then a heap with the highest on top.
    void keep_lowest(const MeetingFaces& faces) noexcept
    {
        if (report_.meeting.try_push_back(faces))
        {
            return;
        }
        if (!report_.is_truncated)
        {
            report_.is_truncated = true;
            std::ranges::make_heap(report_.meeting);
        }
        if (faces < report_.meeting[0])
        {
            std::ranges::pop_heap(report_.meeting);
            report_.meeting.pop_back();
            report_.meeting.push_back(faces);
            std::ranges::push_heap(report_.meeting);
        }
    }

    /// Those that come first among contacts: where they meet is asked at the end.
    void keep_touching(const Meeting& meeting) noexcept
    {
        const bool are_contacts = aim_ == Aim::all && question_.contact_m >= 0.0;
        if (touching_.size() == (are_contacts ? kMaxContacts : 1))
        {
            has_dropped_ = are_contacts;
            if (!comes_before(meeting.faces, touching_[touching_.size() - 1].faces))
            {
                return;
            }
            touching_.pop_back();
        }
        touching_.push_back(meeting);
        for (std::size_t i = touching_.size() - 1;
             i > 0 && comes_before(touching_[i].faces, touching_[i - 1].faces); --i)
        {
            std::swap(touching_[i], touching_[i - 1]);
        }
    }

    void keep_contact(const MeetingFaces& faces, const Triangle& triangle,
                      const ClosestPoints& closest) noexcept
    {
        TACTUS_ASSERT(contacts_ != nullptr);
        const Contact contact = make_contact(closest, triangle, faces.face, faces.tool_face);
        has_dropped_ = !keep_nearest(contact, contacts_->contacts) || has_dropped_;
        if (question_.ends != nullptr)
        {
            keep_ends(contact, *question_.ends);
        }
    }

    [[nodiscard]] ClosestPoints closest_of(const Meeting& meeting) const noexcept
    {
        return closest_points(tool_triangle(meeting.tool_prim), object_triangle(meeting.prim),
                              true);
    }

    [[nodiscard]] Triangle tool_triangle(PrimId prim) const noexcept
    {
        return placed_triangle(triangle_of(question_.tool, prim), question_.place);
    }
    [[nodiscard]] Triangle object_triangle(PrimId prim) const noexcept
    {
        return triangle_of(question_.object, prim);
    }

    const MeshQuestion& question_;
    Aim aim_;
    std::uint32_t enough_;
    double reach_m_;
    WalkBudget& budget_;
    MeshMemory& memory_;
    MeshReport& report_;
    ContactReport* contacts_; ///< Null where none are wanted.
    double tool_quantum_m_;   ///< In the object's frame.
    double quantum_m_;
    MeshViews views_;
    PlacedBlocks placed_;
    double doubt_m_;  ///< Twice the error law of the kernels that measure, for any two faces.
    bool has_coarse_; ///< Either tree has a coarse face.
    bool has_stopped_{false};   ///< No more can be looked at.
    std::uint32_t found_{0};    ///< Pairs that meet.
    PairWalk::Item remembered_; ///< What was looked at first.
    FacePairQueue queue_;       ///< Exact ones.
    FacePairQueue coarse_queue_;
    PairDistances distances_; ///< Of the queue.
    StaticVector<Candidate, kMaxCandidates> candidates_;
    SharedFeatures shared_;                                  ///< Of those that were measured.
    StaticVector<float, kMaxContacts + 1> nearest_contacts_; ///< A heap, the farthest on top.
    std::uint32_t way_number_{0};                            ///< 0: none was found.
    Vec3f way_{};                     ///< Between the nearest that were found.
    double bound_m_{kInfinity};       ///< Some pair is not farther apart, in single precision.
    double open_m_{kInfinity};        ///< Pairs that are not exact or not seen are this far apart;
    double exact_lower_m_{kInfinity}; ///< exact pairs this;
    double upper_m_{kInfinity};       ///< and some pair not farther than this.
    StaticVector<Meeting, kMaxContacts> touching_;
    ClosestPoints nearest_; ///< Of exact pairs, as what follows.
    MeetingFaces nearest_faces_;
    bool has_nearest_{false};
    bool has_dropped_{false}; ///< A contact found no room.
    bool expects_crowd_{false};
};

DistanceAnswer answer_of_meeting(const Witness& witness) noexcept
{
    const ClosestPoints closest = closest_points(witness.tool, witness.triangle, true);
    DistanceAnswer answer;
    answer.kind = AnswerKind::exact;
    answer.lower_m = 0.0;
    answer.upper_m = 0.0;
    answer.tool_point_m = closest.on_shape;
    answer.nearest_face = witness.meeting.faces.face;
    answer.nearest_point_m = closest.on_triangle;
    answer.nearest_feature = closest.feature;
    return answer;
}

/// Where the faces that are remembered still meet there is nothing to search.
bool try_report(const std::optional<Witness>& witness, MeshReport& report) noexcept
{
    if (!witness || !witness->do_meet)
    {
        return false;
    }
    report.meeting.push_back(witness->meeting.faces);
    report.intersection = Intersection::proven;
    return true;
}

/// The same, where the distance is asked for.
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

/// Of query_meshes().
struct MeshAnswers
{
    DistanceAnswer& answer;
    MeshReport& report;
    ContactReport& contacts;
};

/// Where a crowd is expected what meets is looked for alone, in half of the time; without one that
/// says too little, and is false. The answers are the same whatever is expected.
[[gnu::noinline]] bool search_meshes(const MeshQuestion& question, bool expects_crowd,
                                     std::uint32_t enough, OtherSurface& object, MeshMemory& memory,
                                     const std::optional<Witness>& witness,
                                     MeshAnswers& answers) noexcept
{
    MeshSearch search(question, Aim::all, enough, object.budget(), memory, answers.report,
                      &answers.contacts);
    if (expects_crowd)
    {
        search.expect_crowd();
    }
    search.run(&object, witness);
    memory.is_crowded = search.is_crowded();
    if (expects_crowd && !memory.is_crowded)
    {
        answers.report.clear();
        return false;
    }
    answers.answer = search.answer();
    search.report_meeting();
    search.report_contacts(answers.answer);
    return true;
}

} // namespace

void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report, ContactReport& contacts) noexcept
{
    report.clear();
    contacts.clear();
    const std::optional<Witness> witness = find_witness(question, memory.faces, object.budget());
    const std::uint32_t enough = question.wants_pairs        ? kAll
                                 : question.contact_m >= 0.0 ? kEnoughMeetingFaces
                                                             : 1;
    if (enough == 1 && try_answer(witness, answer, report))
    {
        return;
    }
    MeshAnswers answers{answer, report, contacts};
    const bool may_be_full = question.contact_m >= 0.0 && memory.is_crowded;
    if (may_be_full && search_meshes(question, true, enough, object, memory, witness, answers))
    {
        return;
    }
    search_meshes(question, false, enough, object, memory, witness, answers);
}

void find_nearest_faces(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                        DistanceAnswer& answer, MeshReport& report) noexcept
{
    report.clear();
    const std::optional<Witness> witness = find_witness(question, memory.faces, object.budget());
    if (try_answer(witness, answer, report))
    {
        return;
    }
    MeshSearch search(question, Aim::nearest, 1, object.budget(), memory, report, nullptr);
    search.run(&object, witness);
    answer = search.answer();
    search.report_meeting();
    search.report_nearest(answer);
}

void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept
{
    report.clear();
    if (enough == 1 && try_report(find_witness(question, memory.faces, budget), report))
    {
        return;
    }
    MeshSearch search(question, Aim::meeting, enough, budget, memory, report, nullptr);
    search.run(nullptr, std::nullopt);
    search.report_meeting();
}

} // namespace tactus
