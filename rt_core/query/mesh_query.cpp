// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/mesh_query.hpp"

#include "rt_core/geometry/crossing.hpp"
#include "rt_core/geometry/triangle_triangle.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/contact_set.hpp"
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
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

/// The faces of one block of the tool, and their boxes row by axis.
class ToolFaces
{
public:
    void add(const MeshFace& face) noexcept
    {
        const std::size_t lane = faces_.size();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low_[axis][lane] = face.low[static_cast<Eigen::Index>(axis)];
            high_[axis][lane] = face.high[static_cast<Eigen::Index>(axis)];
        }
        low_end_ = lane == 0 ? face.low : least_of(low_end_, face.low);
        high_end_ = lane == 0 ? face.high : greatest_of(high_end_, face.high);
        largest_error_m_ = std::max(largest_error_m_, face.error_m);
        faces_.push_back(face);
    }

    /// Holds all of them, errors left out.
    [[nodiscard]] Ball ball() const noexcept
    {
        const Vec3 half = 0.5 * (high_end_ - low_end_);
        return {low_end_ + half, half.norm() * kRoundedUp};
    }
    [[nodiscard]] const MeshFace& face(std::size_t lane) const noexcept { return faces_[lane]; }
    [[nodiscard]] double largest_error_m() const noexcept { return largest_error_m_; }

    /// Lanes of the faces whose boxes are within `limit_m` of another face's.
    [[nodiscard]] std::uint32_t near(const MeshFace& other, double limit_m) const noexcept
    {
        std::array<double, kBlockFaces> gap_sq{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double other_low = other.low[static_cast<Eigen::Index>(axis)];
            const double other_high = other.high[static_cast<Eigen::Index>(axis)];
            for (std::size_t lane = 0; lane < kBlockFaces; ++lane)
            {
                const double below = other_low - high_[axis][lane];
                const double above = low_[axis][lane] - other_high;
                const double larger = below > above ? below : above;
                const double gap = larger > 0.0 ? larger : 0.0;
                gap_sq[lane] += gap * gap;
            }
        }
        const double limit_sq = limit_m * limit_m * kRoundedUp;
        std::uint32_t lanes = 0;
        for (std::size_t lane = 0; lane < faces_.size(); ++lane)
        {
            lanes |= gap_sq[lane] <= limit_sq ? 1U << lane : 0U;
        }
        return lanes;
    }

private:
    std::array<std::array<double, kBlockFaces>, 3> low_{};
    std::array<std::array<double, kBlockFaces>, 3> high_{};
    StaticVector<MeshFace, kBlockFaces> faces_;
    Vec3 low_end_{0.0, 0.0, 0.0}; ///< Of a box round all.
    Vec3 high_end_{0.0, 0.0, 0.0};
    double largest_error_m_{0.0};
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
    return to_triangle(block_triangle(tree.block(leaf / kBlockFaces), leaf % kBlockFaces));
}

/// One query: the tool's faces near the object, and for each the object's faces near it.
class MeshSearch
{
public:
    MeshSearch(const MeshQuestion& question, OtherSurface& object, QueryMemory& memory,
               MeshReport& report, ContactReport& contacts) noexcept
        : question_(question)
        , object_(object)
        , budget_(object.budget())
        , memory_(memory)
        , report_(report)
        , contacts_(contacts)
        , tool_quantum_m_(static_cast<double>(question.tool.quantum_m()) *
                          question.place.place.scale)
        , quantum_m_(static_cast<double>(question.object.quantum_m()))
    {
    }

    void run() noexcept
    {
        const Ball all = ball_round(question_.tool.box());
        upper_m_ = object_.upper_bound_m(all) * question_.place.place.scale * kRoundedUp;
        const std::uint32_t warm = memory_.block;
        const bool is_warm = question_.tool.is_block_in_use(warm) && budget_.take_node();
        if (is_warm)
        {
            test_tool_block(warm);
        }
        SurfaceWalk walk(question_.tool, object_);
        for (std::uint32_t block = walk.next_block(bound_m(), false); block != kNoNode;
             block = walk.next_block(bound_m(), false))
        {
            if (!is_warm || block != warm)
            {
                test_tool_block(block);
            }
        }
        for (const SurfaceWalk::Item& item : walk.left())
        {
            open_m_ = std::min(open_m_, item.gap_m * question_.place.place.scale);
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

    /// After answer(): what meets, sorted, and the contacts in order.
    void report(const DistanceAnswer& answer) noexcept
    {
        std::ranges::sort_heap(report_.meeting);
        const bool is_all_seen = is_all_there() && open_m_ > 0.0;
        report_.is_complete = is_all_seen && !report_.is_truncated;
        report_.intersection = !report_.meeting.empty() ? Intersection::proven
                               : is_all_seen            ? Intersection::none
                                                        : Intersection::open;
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
        contacts_.is_complete =
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
        return std::max(question_.reach_m, static_cast<double>(kProofShare) * upper_m_);
    }
    /// The same in the tool's model.
    [[nodiscard]] double bound_m() const noexcept
    {
        return worth_m() / question_.place.place.scale * kRoundedUp;
    }

    void test_tool_block(std::uint32_t index) noexcept
    {
        const BlockSide& side = question_.tool.side(index);
        const double upper_before = upper_m_;
        ToolFaces faces;
        for (std::uint32_t lanes = question_.tool.block(index).faces; lanes != 0;
             lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const auto error = static_cast<double>(error_in_quanta(side.errors[lane]));
            faces.add({tool_triangle(side.prims[lane]), question_.tool, side.prims[lane],
                       error * tool_quantum_m_ * kRoundedUp, (side.coarse >> lane & 1U) != 0});
        }
        test_tool_faces(faces);
        memory_.block = upper_m_ < upper_before ? index : memory_.block;
    }

    void test_tool_faces(const ToolFaces& faces) noexcept
    {
        const Ball ball = faces.ball();
        if (is_beyond_kernels(ball.center, question_.object.quantum_m()))
        {
            open_m_ = std::min(open_m_, 0.0);
            return;
        }
        const double wider_m = ball.radius + faces.largest_error_m();
        const KernelProbe probe = make_probe(ball.center, question_.object.quantum_m());
        const auto bound = [&]
        {
            const double quanta = (wider_m + worth_m()) / quantum_m_;
            return quanta < kFarQuanta ? round_up_to_float(quanta)
                                       : std::numeric_limits<float>::infinity();
        };
        TreeWalk walk(question_.object, probe, budget_);
        for (std::uint32_t block = walk.next_block(bound(), false); block != kNoNode;
             block = walk.next_block(bound(), false))
        {
            if (!budget_.take_triangles(face_count(question_.object.block(block))))
            {
                open_m_ = std::min(open_m_, 0.0); // Its parent's bound may have gone with it.
                break;
            }
            test_object_block(block, faces, probe, wider_m);
        }
        for (const WalkItem& item : walk.left())
        {
            open_m_ = std::min(open_m_, static_cast<double>(item.gap) * quantum_m_ - wider_m);
        }
    }

    void test_object_block(std::uint32_t index, const ToolFaces& tool_faces,
                           const KernelProbe& probe, double wider_m) noexcept
    {
        const BlockGeometry& block = question_.object.block(index);
        const BlockSide& side = question_.object.side(index);
        FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        bound_faces(question_.object.kernels(), block, block.faces, probe, bounds);
        for (std::uint32_t lanes = block.faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const double error =
                static_cast<double>(error_in_quanta(side.errors[lane])) * quantum_m_;
            if (static_cast<double>(bounds.lower[lane]) * quantum_m_ - wider_m - error <= worth_m())
            {
                test_object_face({to_triangle(block_triangle(block, lane)), question_.object,
                                  side.prims[lane], error, (side.coarse >> lane & 1U) != 0},
                                 tool_faces);
            }
        }
    }

    void test_object_face(const MeshFace& face, const ToolFaces& tool_faces) noexcept
    {
        const double limit = worth_m() + tool_faces.largest_error_m() + face.error_m;
        for (std::uint32_t near = tool_faces.near(face, limit); near != 0; near &= near - 1)
        {
            test_pair(tool_faces.face(static_cast<std::size_t>(std::countr_zero(near))), face);
        }
    }

    void test_pair(const MeshFace& tool_face, const MeshFace& face) noexcept
    {
        const BoxGap boxes = box_gap(tool_face, face);
        const double lower = boxes.distance_m - tool_face.error_m - face.error_m;
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
        if (boxes.distance_m == 0.0 && meet(tool_face.triangle, face.triangle))
        {
            add_meeting({faces, tool_face.prim, face.prim});
        }
        else if (boxes.distance_m <= std::max(kept_contact_m(), nearest_m(boxes.span_m)))
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
        const ContactSet& kept = contacts_.contacts;
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
        keep_lowest(meeting.faces);
        keep_touching(meeting);
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
        const Contact contact = make_contact(closest, triangle, faces.face, faces.tool_face);
        has_dropped_ = !keep_nearest(contact, contacts_.contacts) || has_dropped_;
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
    OtherSurface& object_;
    WalkBudget& budget_;
    QueryMemory& memory_;
    MeshReport& report_;
    ContactReport& contacts_;
    double tool_quantum_m_; ///< In the object's frame.
    double quantum_m_;
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

void query_meshes(const MeshQuestion& question, OtherSurface& object, QueryMemory& memory,
                  DistanceAnswer& answer, MeshReport& report, ContactReport& contacts) noexcept
{
    report.clear();
    contacts.clear();
    MeshSearch search(question, object, memory, report, contacts);
    search.run();
    answer = search.answer();
    search.report(answer);
}

} // namespace tactus
