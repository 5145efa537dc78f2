// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/mesh_findings.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/contact_set.hpp"
#include "rt_core/query/surface_query.hpp"

#include <cmath>
#include <tuple>
#include <utility>

namespace tactus
{

namespace
{

/// Factor on the distance of the farthest kept contact within which contacts may be ends.
constexpr double kEndsAsNear = 1.1;

Triangle triangle_of(const AbTree& tree, PrimId prim) noexcept
{
    const std::uint32_t leaf = tree.leaf_of(prim);
    TACTUS_ASSERT(leaf != AbTree::kNoLeaf);
    return to_triangle(block_triangle(tree.block(leaf / kBlockFaces), leaf % kBlockFaces));
}

/// Largest error of two faces that count as the surface.
double tolerance_m(const MeshQuestion& question) noexcept
{
    const auto error_m = [](ErrorCode code, const AbTree& tree)
    { return static_cast<double>(error_in_quanta(code)) * static_cast<double>(tree.quantum_m()); };
    return (question.place.place.scale * error_m(question.tool_tolerance, question.tool) +
            error_m(question.tolerance, question.object)) *
           kRoundedUp;
}

/// True if any face of a tree is not exact.
bool has_coarse(const AbTree& tree) noexcept
{
    const TreeRef root = tree.root();
    return !root.is_none() &&
           (root.is_block() ? tree.side(root.index()).coarse : tree.node(root.index()).coarse) != 0;
}

} // namespace

bool comes_before(const MeetingFaces& a, const MeetingFaces& b) noexcept
{
    return std::tie(a.face, a.tool_face) < std::tie(b.face, b.tool_face);
}

double corners_apart(const Triangle& a, const Triangle& b) noexcept
{
    double nearest_sq = kInfinity;
    for (const Vec3& corner : a)
    {
        for (const Vec3& other : b)
        {
            nearest_sq = std::min(nearest_sq, (corner - other).squaredNorm());
        }
    }
    return std::sqrt(nearest_sq) * kRoundedUp;
}

Triangle placed_triangle(const Triangle& there, const MeshPlacement& place) noexcept
{
    return {place.local_to_world(there[0]), place.local_to_world(there[1]),
            place.local_to_world(there[2])};
}

MeshFindings::MeshFindings(const MeshQuestion& question, Aim aim, std::uint32_t enough,
                           double doubt_m, MeshReport& report, ContactReport* contacts) noexcept
    : question_(question)
    , aim_(aim)
    , enough_(enough)
    , reach_m_(aim == Aim::nearest ? kInfinity : question.reach_m)
    , looked_m_(question.is_tolerant() ? reach_m_ + tolerance_m(question) : reach_m_)
    , quantum_m_(static_cast<double>(question.object.quantum_m()))
    , doubt_m_(doubt_m)
    , report_(report)
    , contacts_(contacts)
    , has_coarse_(tactus::has_coarse(question.tool) || tactus::has_coarse(question.object))
{
    TACTUS_ASSERT(question.reach_m >= 0.0);
    TACTUS_ASSERT(enough > 0);
    TACTUS_ASSERT(aim != Aim::all || contacts != nullptr);
}

void MeshFindings::leave_open() noexcept
{
    if (has_coarse_)
    {
        leave(question_.certified_m);
    }
    leaves_open_ = true;
}

bool MeshFindings::has_expected_contacts() const noexcept
{
    return expected_m_ >= question_.contact_m || is_enough() ||
           (nearest_contacts_.full() && farthest_contact_m() <= expected_m_);
}

double MeshFindings::farthest_contact_m() const noexcept
{
    return nearest_contacts_.full()
               ? static_cast<double>(nearest_contacts_[0]) * quantum_m_ * kRoundedUp
               : -1.0;
}

bool MeshFindings::exceeds_capacity() const noexcept
{
    return touching_.size() == kMaxContacts && found_ > kMaxContacts;
}

double MeshFindings::worth_m() const noexcept
{
    switch (aim_)
    {
    case Aim::all:
        return std::max(looked_m_, share_ * bound_m_);
    case Aim::nearest:
        return bound_m_ + doubt_m_;
    case Aim::meeting:
        break;
    }
    return 0.0;
}

double MeshFindings::measured_m() const noexcept
{
    if (aim_ == Aim::meeting || needs_only_meeting())
    {
        return -1.0;
    }
    const double nearest_m = bound_m_ > 0.0 ? bound_m_ + doubt_m_ : -1.0;
    return std::min(worth_m(), std::max(asked_contact_m(), nearest_m));
}

bool MeshFindings::needs_open() const noexcept
{
    return has_coarse_ && !leaves_open_ && !is_left_open() &&
           !(question_.certified_m > worth_m() * kRoundedUp);
}

double MeshFindings::walked_m() const noexcept
{
    return needs_open() ? worth_m() : std::max(measured_m(), 0.0);
}

double MeshFindings::contact_zone_m() const noexcept
{
    return question_.ends != nullptr
               ? std::min(measured_m(), std::max(kept_contact_m(), bound_m_ + doubt_m_))
               : measured_m();
}

void MeshFindings::take_upper(double upper_m) noexcept
{
    upper_m_ = std::min(upper_m_, upper_m);
    bound_m_ = std::min(bound_m_, upper_m_);
}

void MeshFindings::add_apart(const MeetingFaces& faces, const Triangle& triangle,
                             const ClosestPoints& closest, double error_m) noexcept
{
    const double upper_m = closest.distance + closest.distance_error;
    if (error_m > 0.0)
    {
        tolerate(closest.distance - closest.distance_error, error_m);
        bound_m_ = std::min(bound_m_, upper_m);
    }
    else
    {
        exact_lower_m_ =
            std::min(exact_lower_m_, std::max(0.0, closest.distance - closest.distance_error));
        take_upper(upper_m);
    }
    if (aim_ == Aim::all && !expects_exceeded_capacity_ && closest.distance <= question_.contact_m)
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

void MeshFindings::add_meeting(const Meeting& meeting, double error_m) noexcept
{
    ++found_;
    if (error_m > 0.0)
    {
        tolerate(0.0, error_m);
        bound_m_ = std::min(bound_m_, 0.0);
    }
    else
    {
        exact_lower_m_ = 0.0;
        take_upper(0.0);
        keep_lowest(meeting.faces);
    }
    if (aim_ != Aim::meeting)
    {
        keep_touching(meeting);
    }
}

void MeshFindings::count_contact(float upper) noexcept
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

DistanceAnswer MeshFindings::answer() noexcept
{
    Findings found;
    found.exact_lower_m = exact_lower_m_;
    found.tolerated_lower_m = tolerated_lower_m_;
    found.upper_m = upper_m_;
    found.open_m = is_all_there() ? open_m_ : std::min(open_m_, 0.0);
    if (enough_ == 1 || is_enough())
    {
        // No face is nearer than one that meets, so `open_m` need not be below zero.
        found.open_m = std::max(found.open_m, 0.0);
    }
    if (!knows_nearest())
    {
        // Pairs within the tolerance that were not measured are only a bound.
        found.open_m = std::min(found.open_m, tolerated_lower_m_);
        found.tolerated_lower_m = kInfinity;
    }
    found.pruned_m = bound_m_ > looked_m_ ? worth_m() : kInfinity;
    found.dropped_m = kInfinity;
    DistanceAnswer answer = answer_from(found, reach_m_);
    answer.tolerated_m = tolerated_m_;
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

void MeshFindings::report_meeting() noexcept
{
    TACTUS_ASSERT(report_.meeting.size() <= found_);
    if (!report_.is_truncated)
    {
        std::ranges::make_heap(report_.meeting);
    }
    std::ranges::sort_heap(report_.meeting);
    const bool is_all_seen = is_all_there() && open_m_ > 0.0 && tolerated_lower_m_ > 0.0;
    report_.is_truncated = report_.is_truncated || (is_enough() && enough_ > 1);
    report_.is_complete = is_all_seen && !report_.is_truncated && !is_enough();
    report_.intersection = !report_.meeting.empty() ? Intersection::proven
                           : has_met()              ? Intersection::within_tolerance
                           : is_all_seen            ? Intersection::none
                                                    : Intersection::open;
}

void MeshFindings::report_nearest(const DistanceAnswer& answer) noexcept
{
    report_.nearest_tool_face = answer.nearest_face.is_none() ? FaceId{} : nearest_faces_.tool_face;
}

void MeshFindings::report_contacts(const DistanceAnswer& answer) noexcept
{
    report_nearest(answer);
    if (question_.contact_m < 0.0)
    {
        return;
    }
    // Contacts between separate faces were skipped in part, so all of them are dropped.
    if (exceeds_capacity())
    {
        contacts_->contacts.clear();
        drop_ends();
    }
    for (const Meeting& meeting : touching_)
    {
        keep_contact(meeting.faces, object_triangle(meeting.prim), closest_of(meeting));
    }
    contacts_->is_complete =
        !has_dropped_ && !is_enough() &&
        (answer.certified_radius_m >= question_.contact_m || answer.lower_m > question_.contact_m);
}

/// True if an open face may meet the other surface and the two are in reach: further open faces
/// change no result.
bool MeshFindings::is_left_open() const noexcept
{
    return open_m_ <= 0.0 && (aim_ == Aim::meeting || needs_only_meeting() ||
                              (aim_ == Aim::all && bound_m_ <= reach_m_));
}

/// True if the points of a nearest pair are known.
bool MeshFindings::knows_nearest() const noexcept
{
    return has_nearest_ || !touching_.empty();
}

/// True if one meeting pair is enough and some pair may meet: contacts and distances change no
/// result.
bool MeshFindings::needs_only_meeting() const noexcept
{
    return aim_ == Aim::all && enough_ == 1 && question_.contact_m >= 0.0 && open_m_ <= 0.0;
}

/// Distance beyond which no contact is kept; negative if no contact is.
double MeshFindings::kept_contact_m() const noexcept
{
    if (aim_ != Aim::all || expects_exceeded_capacity_)
    {
        return -1.0;
    }
    // Contacts of meeting faces come before contacts of separate faces.
    const ContactSet& apart = contacts_->contacts;
    const std::size_t room = kMaxContacts - touching_.size();
    double farthest_m = std::min(question_.contact_m, expected_m_);
    if (nearest_contacts_.full())
    {
        farthest_m = std::min(farthest_m, farthest_contact_m());
    }
    if (!has_dropped_ && apart.size() <= room)
    {
        return farthest_m;
    }
    return room == 0 ? -1.0 : std::min(apart[room - 1].distance_m, farthest_m);
}

/// Distance beyond which contacts are neither kept nor ends; negative if no contact is.
double MeshFindings::asked_contact_m() const noexcept
{
    const double as_near = question_.ends != nullptr ? kEndsAsNear : 1.0;
    return std::min(as_near * kept_contact_m(), question_.contact_m);
}

bool MeshFindings::is_all_there() const noexcept
{
    return question_.tool.is_complete() && question_.object.is_complete();
}

void MeshFindings::drop_ends() const noexcept
{
    if (question_.ends != nullptr)
    {
        question_.ends->is_empty = true;
    }
}

/// Keeps the meeting pairs with the lowest ids: in any order until the list is full, then as a heap
/// with the highest on top.
void MeshFindings::keep_lowest(const MeetingFaces& faces) noexcept
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

/// Keeps the first meeting pairs in the order of contacts, or just one if no contacts are
/// requested. Their contact points are computed at the end.
void MeshFindings::keep_touching(const Meeting& meeting) noexcept
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

void MeshFindings::keep_contact(const MeetingFaces& faces, const Triangle& triangle,
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

ClosestPoints MeshFindings::closest_of(const Meeting& meeting) const noexcept
{
    return closest_points(tool_triangle(meeting.tool_prim), object_triangle(meeting.prim), true);
}

Triangle MeshFindings::tool_triangle(PrimId prim) const noexcept
{
    return placed_triangle(triangle_of(question_.tool, prim), question_.place);
}

Triangle MeshFindings::object_triangle(PrimId prim) const noexcept
{
    return triangle_of(question_.object, prim);
}

} // namespace tactus
