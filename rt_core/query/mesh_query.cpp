// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/mesh_query.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/crossing.hpp"
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
#include <cmath>
#include <limits>
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
    PrimId prim{};
    FaceId id{};
    double error_m{0.0};
    bool is_coarse{false};
    Vec3 low{0.0, 0.0, 0.0}; ///< Of its box.
    Vec3 high{0.0, 0.0, 0.0};

    MeshFace(const Triangle& corners, const AbTree& tree, PrimId face, double error,
             bool coarse) noexcept
        : triangle(corners)
        , prim(face)
        , id(tree.face_of(face))
        , error_m(error)
        , is_coarse(coarse)
        , low(least_of(least_of(corners[0], corners[1]), corners[2]))
        , high(greatest_of(greatest_of(corners[0], corners[1]), corners[2]))
    {
    }
};

/// Of the boxes of two faces.
struct BoxGap
{
    double distance_m;
    double span_m; ///< Diagonal of a box round both; the kernel's error goes with it at most.
};

BoxGap box_gap(const MeshFace& a, const MeshFace& b) noexcept
{
    double gap_sq = 0.0;
    double span_sq = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double gap = std::max({b.low[axis] - a.high[axis], a.low[axis] - b.high[axis], 0.0});
        const double span =
            std::max(a.high[axis], b.high[axis]) - std::min(a.low[axis], b.low[axis]);
        gap_sq += gap * gap;
        span_sq += span * span;
    }
    return {std::sqrt(gap_sq) / kRoundedUp, std::sqrt(span_sq) * kRoundedUp};
}

/// Two faces that single precision does not tell to be far apart.
struct Candidate
{
    std::uint32_t tool_lane;
    std::uint32_t lane;
    float gap; ///< They are at least this far apart, in quanta.
};

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

/// What a search is for.
enum class Aim : std::uint8_t
{
    distance, ///< And all that meets.
    meeting,  ///< Which needs no measuring.
};
constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

/// One query: the pairs of blocks that are near, and of each the pairs of faces.
class MeshSearch
{
public:
    /// Ends when `enough` pairs meet.
    MeshSearch(const MeshQuestion& question, Aim aim, std::uint32_t enough, WalkBudget& budget,
               MeshMemory& memory, MeshReport& report, ContactReport* contacts) noexcept
        : question_(question)
        , aim_(aim)
        , enough_(enough)
        , budget_(budget)
        , memory_(memory)
        , report_(report)
        , contacts_(contacts)
        , tool_quantum_m_(static_cast<double>(question.tool.quantum_m()) *
                          question.place.place.scale)
        , quantum_m_(static_cast<double>(question.object.quantum_m()))
        , views_(question.tool, question.object, question.place)
        , placed_(question.tool, question.object, question.place, views_)
    {
        TACTUS_ASSERT(question.reach_m >= 0.0);
        TACTUS_ASSERT(enough > 0);
        TACTUS_ASSERT(aim == Aim::meeting || contacts != nullptr);
    }

    /// `object` is asked how far away it is where nothing is remembered; null when that is not
    /// wanted.
    void run(OtherSurface* object) noexcept
    {
        if (question_.tool.root().is_none() || question_.object.root().is_none())
        {
            return;
        }
        const bool is_near = !views_.is_beyond_kernels();
        if (is_near)
        {
            search_remembered();
        }
        // Where a distance is wanted there has to be a bound, before anything can be left out.
        if (object != nullptr && upper_m_ == kInfinity)
        {
            upper_m_ = object->upper_bound_m(ball_round(question_.tool.box())) *
                       question_.place.place.scale * kRoundedUp;
        }
        if (is_near)
        {
            search_all();
        }
        else
        {
            const double gap_m = balls_gap_m();
            leave(gap_m > 0.0 ? gap_m : 0.0); // Not a number: nothing is known.
        }
    }

    [[nodiscard]] DistanceAnswer answer() noexcept
    {
        Findings found;
        found.exact_lower_m = exact_lower_m_;
        found.upper_m = upper_m_;
        found.open_m = is_all_there() ? open_m_ : std::min(open_m_, 0.0);
        found.pruned_m = upper_m_ > question_.reach_m ? worth_m() : kInfinity;
        found.dropped_m = kInfinity;
        DistanceAnswer answer = answer_from(found, question_.reach_m);
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
        std::ranges::sort_heap(report_.meeting);
        const bool is_all_seen = is_all_there() && open_m_ > 0.0;
        report_.is_complete = is_all_seen && !report_.is_truncated && !is_enough();
        report_.intersection = !report_.meeting.empty() ? Intersection::proven
                               : is_all_seen            ? Intersection::none
                                                        : Intersection::open;
    }

    /// The contacts in order, and the tool's face of the nearest pair.
    void report_contacts(const DistanceAnswer& answer) noexcept
    {
        report_.nearest_tool_face =
            answer.nearest_face.is_none() ? FaceId{} : nearest_faces_.tool_face;
        if (question_.contact_m < 0.0)
        {
            return;
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
    [[nodiscard]] bool is_all_there() const noexcept
    {
        return question_.tool.is_complete() && question_.object.is_complete();
    }

    /// What is farther changes nothing; never grows.
    [[nodiscard]] double worth_m() const noexcept
    {
        return aim_ == Aim::distance
                   ? std::max(question_.reach_m, static_cast<double>(kProofShare) * upper_m_)
                   : 0.0;
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

    /// First the blocks that are remembered: their bound leaves little to look at.
    void search_remembered() noexcept
    {
        warm_ = memory_;
        is_warm_ = question_.tool.is_block_in_use(warm_.tool_block) &&
                   question_.object.is_block_in_use(warm_.block) && budget_.take_node();
        if (is_warm_)
        {
            test_blocks(warm_);
        }
    }

    void search_all() noexcept
    {
        PairWalk walk(question_.tool, question_.object, views_, budget_);
        while (!is_enough() && !has_stopped_)
        {
            const PairWalk::Item* near = walk.next_blocks(bound_quanta(0.0));
            if (near == nullptr)
            {
                break;
            }
            const MeshMemory blocks{near->tool.index(), near->object.index()};
            if (!is_warm_ || blocks != warm_)
            {
                test_blocks(blocks);
            }
        }
        for (const PairWalk::Item& item : walk.left())
        {
            leave(static_cast<double>(item.gap) * quantum_m_);
        }
    }

    /// The same for the kernels, of faces with such an error.
    [[nodiscard]] float bound_quanta(double error_m) const noexcept
    {
        const double quanta = (worth_m() + error_m) / quantum_m_ * kRoundedUp;
        return quanta < kFarQuanta ? round_up_to_float(quanta)
                                   : std::numeric_limits<float>::infinity();
    }

    void test_blocks(const MeshMemory& blocks) noexcept
    {
        TACTUS_ASSERT(question_.object.is_block_in_use(blocks.block));
        const BlockGeometry& block = question_.object.block(blocks.block);
        if (!budget_.take_triangles(face_count(block)))
        {
            leave(0.0); // Its parent's bound may have gone with it.
            has_stopped_ = true;
            return;
        }
        const PlacedBlock& tool = placed_.get(blocks.tool_block);
        const double error_m =
            tool.largest_error_m +
            static_cast<double>(largest_error_quanta(question_.object.side(blocks.block))) *
                quantum_m_;
        find_candidates(blocks, tool, bound_quanta(error_m));
        if (!budget_.take_triangles(static_cast<std::uint32_t>(candidates_.size())))
        {
            leave(0.0);
            has_stopped_ = true;
            return;
        }
        const double upper_before = upper_m_;
        for (const Candidate& candidate : candidates_)
        {
            if (is_enough())
            {
                break;
            }
            if (static_cast<double>(candidate.gap) * quantum_m_ <= worth_m() + error_m)
            {
                test_pair(tool_face(blocks.tool_block, tool, candidate.tool_lane),
                          object_face(blocks.block, candidate.lane),
                          static_cast<double>(candidate.gap) * quantum_m_);
            }
        }
        memory_ = upper_m_ < upper_before ? blocks : memory_;
    }

    /// The nearest first: its bound spares the others' measuring.
    void find_candidates(const MeshMemory& blocks, const PlacedBlock& tool, float bound) noexcept
    {
        const Kernels& kernels = question_.object.kernels();
        const BlockGeometry& block = question_.object.block(blocks.block);
        TriangleRows rows; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        kernels.place_triangles(block.coordinates.front().data(), block.corners.front().data(),
                                tool.box.center, rows);
        candidates_.clear();
        const std::uint32_t lanes = kernels.near_faces(rows, tool.box, block.faces, bound);
        if (lanes == 0)
        {
            return;
        }
        const std::uint32_t tool_lanes = kernels.near_lanes(
            tool.rows, rows, lanes, question_.tool.block(blocks.tool_block).faces, bound,
            views_.slack());
        // One face against sixteen costs the same whoever has the one.
        const bool is_tool_fewer = std::popcount(tool_lanes) < std::popcount(lanes);
        const TriangleRows& ones = is_tool_fewer ? tool.rows : rows;
        const TriangleRows& others = is_tool_fewer ? rows : tool.rows;
        for (std::uint32_t left = is_tool_fewer ? tool_lanes : lanes; left != 0; left &= left - 1)
        {
            const auto one = static_cast<std::uint32_t>(std::countr_zero(left));
            alignas(64) std::array<float, kBlockFaces> gaps; // NOLINT: the kernel fills it.
            for (std::uint32_t near =
                     kernels.triangle_gaps(others, ones, one, is_tool_fewer ? lanes : tool_lanes,
                                           bound, views_.slack(), gaps.data());
                 near != 0; near &= near - 1)
            {
                const auto other = static_cast<std::uint32_t>(std::countr_zero(near));
                add_candidate(is_tool_fewer ? Candidate{one, other, gaps[other]}
                                            : Candidate{other, one, gaps[other]});
            }
        }
    }

    void add_candidate(const Candidate& candidate) noexcept
    {
        candidates_.push_back(candidate);
        if (candidate.gap < candidates_[0].gap)
        {
            std::swap(candidates_[0], candidates_[candidates_.size() - 1]);
        }
    }

    [[nodiscard]] MeshFace tool_face(std::uint32_t block, const PlacedBlock& placed,
                                     std::uint32_t lane) const noexcept
    {
        const BlockSide& side = question_.tool.side(block);
        const auto error = static_cast<double>(error_in_quanta(side.errors[lane]));
        return {placed.triangle(question_.tool.block(block), lane), question_.tool,
                side.prims[lane], error * tool_quantum_m_ * kRoundedUp,
                (side.coarse >> lane & 1U) != 0};
    }
    [[nodiscard]] MeshFace object_face(std::uint32_t block, std::uint32_t lane) const noexcept
    {
        const BlockSide& side = question_.object.side(block);
        const auto error = static_cast<double>(error_in_quanta(side.errors[lane]));
        return {to_triangle(block_triangle(question_.object.block(block), lane)), question_.object,
                side.prims[lane], error * quantum_m_, (side.coarse >> lane & 1U) != 0};
    }

    /// `gap_m`: what the kernels know them to be apart.
    void test_pair(const MeshFace& tool_face, const MeshFace& face, double gap_m) noexcept
    {
        const BoxGap boxes = box_gap(tool_face, face);
        const double apart_m = std::max(boxes.distance_m, gap_m);
        const double lower = apart_m - tool_face.error_m - face.error_m;
        if (lower > worth_m())
        {
            return;
        }
        if (tool_face.is_coarse || face.is_coarse)
        {
            if (lower < open_m_)
            {
                bound_by_coarse(tool_face, face);
            }
            return;
        }
        const MeetingFaces faces{tool_face.id, face.id};
        if (apart_m == 0.0 && meet(tool_face.triangle, face.triangle))
        {
            add_meeting({faces, tool_face.prim, face.prim});
        }
        else if (aim_ == Aim::distance &&
                 apart_m <= std::max(kept_contact_m(), nearest_m(boxes.span_m)))
        {
            add_apart(faces, face.triangle, closest_points(tool_face.triangle, face.triangle));
        }
    }

    /// Exact pairs that are farther apart have no part in L and U, whatever their error.
    [[nodiscard]] double nearest_m(double span_m) const noexcept
    {
        return upper_m_ > 0.0 ? upper_m_ + kSpanError * span_m : -1.0;
    }

    /// Contacts that are farther apart change nothing; negative when none does.
    [[nodiscard]] double kept_contact_m() const noexcept
    {
        if (!has_dropped_)
        {
            return question_.contact_m;
        }
        const ContactSet& kept = contacts_->contacts;
        return touching_.size() == kMaxContacts ? -1.0
               : kept.size() == kMaxContacts    ? kept[kMaxContacts - 1].distance_m
                                                : question_.contact_m;
    }

    /// The corners of coarse faces are original vertices.
    void bound_by_coarse(const MeshFace& tool_face, const MeshFace& face) noexcept
    {
        const ClosestPoints closest = closest_points(tool_face.triangle, face.triangle);
        open_m_ = std::min(open_m_, closest.distance - closest.distance_error - tool_face.error_m -
                                        face.error_m);
        double nearest_sq = kInfinity;
        for (const Vec3& tool_corner : tool_face.triangle)
        {
            for (const Vec3& corner : face.triangle)
            {
                nearest_sq = std::min(nearest_sq, (tool_corner - corner).squaredNorm());
            }
        }
        upper_m_ = std::min(upper_m_, std::sqrt(nearest_sq) * kRoundedUp);
    }

    void add_apart(const MeetingFaces& faces, const Triangle& triangle,
                   const ClosestPoints& closest) noexcept
    {
        exact_lower_m_ =
            std::min(exact_lower_m_, std::max(0.0, closest.distance - closest.distance_error));
        upper_m_ = std::min(upper_m_, closest.distance + closest.distance_error);
        if (closest.distance <= question_.contact_m)
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
        upper_m_ = 0.0;
        ++found_;
        keep_lowest(meeting.faces);
        if (aim_ == Aim::distance)
        {
            keep_touching(meeting);
        }
    }

    /// A heap with the highest on top.
    void keep_lowest(const MeetingFaces& faces) noexcept
    {
        if (report_.meeting.size() == kMaxMeetingFaces)
        {
            report_.is_truncated = true;
            if (faces > report_.meeting[0])
            {
                return;
            }
            std::ranges::pop_heap(report_.meeting);
            report_.meeting.pop_back();
        }
        report_.meeting.push_back(faces);
        std::ranges::push_heap(report_.meeting);
    }

    /// Those that come first among contacts: where they meet is asked at the end.
    void keep_touching(const Meeting& meeting) noexcept
    {
        if (touching_.size() == kMaxContacts)
        {
            has_dropped_ = question_.contact_m >= 0.0;
            if (!comes_before(meeting.faces, touching_[kMaxContacts - 1].faces))
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
    }

    [[nodiscard]] ClosestPoints closest_of(const Meeting& meeting) const noexcept
    {
        return closest_points(tool_triangle(meeting.tool_prim), object_triangle(meeting.prim));
    }

    [[nodiscard]] Triangle tool_triangle(PrimId prim) const noexcept
    {
        Triangle triangle = triangle_of(question_.tool, prim);
        for (Vec3& corner : triangle)
        {
            corner = question_.place.to_there(corner);
        }
        return triangle;
    }
    [[nodiscard]] Triangle object_triangle(PrimId prim) const noexcept
    {
        return triangle_of(question_.object, prim);
    }

    const MeshQuestion& question_;
    Aim aim_;
    std::uint32_t enough_;
    WalkBudget& budget_;
    MeshMemory& memory_;
    MeshReport& report_;
    ContactReport* contacts_; ///< Null where no distance is wanted.
    double tool_quantum_m_;   ///< In the object's frame.
    double quantum_m_;
    MeshViews views_;
    PlacedBlocks placed_;
    MeshMemory warm_; ///< What was looked at first,
    bool is_warm_{false};
    bool has_stopped_{false}; ///< and no more can be.
    std::uint32_t found_{0};  ///< Pairs that meet.
    StaticVector<Candidate, std::size_t{kBlockFaces} * kBlockFaces> candidates_; ///< Of two blocks.
    double open_m_{kInfinity};        ///< Pairs that are not exact or not seen are this far apart;
    double exact_lower_m_{kInfinity}; ///< exact pairs this;
    double upper_m_{kInfinity};       ///< and some pair not farther than this.
    StaticVector<Meeting, kMaxContacts> touching_;
    ClosestPoints nearest_; ///< Of exact pairs, as what follows.
    MeetingFaces nearest_faces_;
    bool has_nearest_{false};
    bool has_dropped_{false}; ///< A contact found no room.
};

} // namespace

void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report, ContactReport& contacts) noexcept
{
    report.clear();
    contacts.clear();
    MeshSearch search(question, Aim::distance, kAll, object.budget(), memory, report, &contacts);
    search.run(&object);
    answer = search.answer();
    search.report_meeting();
    search.report_contacts(answer);
}

void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept
{
    report.clear();
    MeshSearch search(question, Aim::meeting, enough, budget, memory, report, nullptr);
    search.run(nullptr);
    search.report_meeting();
}

} // namespace tactus
