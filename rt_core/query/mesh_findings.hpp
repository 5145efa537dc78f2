// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/mesh_query.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// What a search is for.
enum class Aim : std::uint8_t
{
    all,     ///< Distance within the reach, what meets, contacts.
    nearest, ///< The distance.
    meeting, ///< What meets, which needs no measuring.
};

/// Exact faces that share a point.
struct Meeting
{
    MeetingFaces faces;
    PrimId tool_prim{};
    PrimId prim{};
};

/// In the order of contacts.
[[nodiscard]] bool comes_before(const MeetingFaces& a,
                                const MeetingFaces& b) noexcept TACTUS_NONBLOCKING;

[[nodiscard]] Triangle placed_triangle(const Triangle& there,
                                       const MeshPlacement& place) noexcept TACTUS_NONBLOCKING;

/// What a query of two meshes has found, what therefore still matters, and the report of it in the
/// end. Lengths are of the object's frame. Haptic thread.
class MeshFindings // NOLINT(cppcoreguidelines-pro-type-member-init): lists are empty.
{
public:
    /// `doubt_m` is twice the error law of the kernels that measure, for any two faces; `contacts`
    /// is null where none are wanted. Some `enough` pairs that meet end the search.
    MeshFindings(const MeshQuestion& question, Aim aim, std::uint32_t enough, double doubt_m,
                 MeshReport& report, ContactReport* contacts) noexcept TACTUS_NONBLOCKING;

    /// Contacts that are apart are not looked for: good only where exceeds_capacity() in the end.
    void expect_crowd() noexcept { expects_crowd_ = true; }
    /// Where nothing is in reach, this share of the distance is proven, above 0.
    void prove(double share) noexcept { share_ = share; }
    /// Coarse faces are not looked at: what the question has certified is all that is known of
    /// them.
    void leave_coarse() noexcept TACTUS_NONBLOCKING;
    /// Whether a distance beyond the reach would change nothing.
    [[nodiscard]] bool asks_for_reach_only() const noexcept
    {
        return aim_ == Aim::all && worth_m() <= reach_m_;
    }
    /// Contacts are looked for within this only: good where there are enough of them.
    void expect_contacts(double within_m) noexcept { expected_m_ = within_m; }
    /// Whether there are, or something else ended the search.
    [[nodiscard]] bool has_expected_contacts() const noexcept TACTUS_NONBLOCKING;
    /// Of one contact more than there is room for; negative where all have room.
    [[nodiscard]] double farthest_contact_m() const noexcept TACTUS_NONBLOCKING;
    /// What meets leaves no room for other contacts.
    [[nodiscard]] bool exceeds_capacity() const noexcept TACTUS_NONBLOCKING;
    /// What is farther changes nothing; never grows.
    [[nodiscard]] double worth_m() const noexcept TACTUS_NONBLOCKING;
    /// Exact pairs that are farther apart need no measuring; negative when none does.
    [[nodiscard]] double measured_m() const noexcept TACTUS_NONBLOCKING;
    /// Whether coarse faces may be near enough to change something; where they aren't they never
    /// will be, as what matters never grows.
    [[nodiscard]] bool needs_coarse() const noexcept TACTUS_NONBLOCKING;
    /// What is farther apart in space needs no look, whether exact or not.
    [[nodiscard]] double walked_m() const noexcept TACTUS_NONBLOCKING;
    /// Farther pairs are neither the nearest nor contacts that are kept, and could only be ends.
    [[nodiscard]] double contact_zone_m() const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_enough() const noexcept { return found_ >= enough_; }
    [[nodiscard]] bool has_met() const noexcept { return found_ > 0; }
    /// Some pair is not farther apart, in single precision.
    [[nodiscard]] double bound_m() const noexcept { return bound_m_; }
    /// What is not exact or was not looked at is this far away.
    [[nodiscard]] double open_m() const noexcept { return open_m_; }

    /// False where nearer ones were known.
    [[nodiscard]] bool try_bound(double upper_m) noexcept
    {
        const bool is_nearer = upper_m < bound_m_;
        bound_m_ = is_nearer ? upper_m : bound_m_;
        return is_nearer;
    }
    /// Something was not looked at that is at least this far away.
    void leave(double gap_m) noexcept { open_m_ = std::min(open_m_, gap_m); }
    void take_upper(double upper_m) noexcept TACTUS_NONBLOCKING;
    void add_apart(const MeetingFaces& faces, const Triangle& triangle,
                   const ClosestPoints& closest) noexcept TACTUS_NONBLOCKING;
    void add_meeting(const Meeting& meeting) noexcept TACTUS_NONBLOCKING;
    /// Of a pair that is no farther apart. Of more contacts than there is room for those are not
    /// kept that all of `nearest_contacts_` are nearer than: the search need not go there.
    void count_contact(float upper) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] DistanceAnswer answer() noexcept TACTUS_NONBLOCKING;
    /// What meets, sorted.
    void report_meeting() noexcept TACTUS_NONBLOCKING;
    /// The tool's face of the nearest pair.
    void report_nearest(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;
    /// The contacts in order, and the tool's face of the nearest pair.
    void report_contacts(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] bool is_left_open() const noexcept;
    [[nodiscard]] bool needs_only_meeting() const noexcept;
    [[nodiscard]] double kept_contact_m() const noexcept;
    [[nodiscard]] double asked_contact_m() const noexcept;
    [[nodiscard]] bool is_all_there() const noexcept;
    void drop_ends() const noexcept;
    void keep_lowest(const MeetingFaces& faces) noexcept;
    void keep_touching(const Meeting& meeting) noexcept;
    void keep_contact(const MeetingFaces& faces, const Triangle& triangle,
                      const ClosestPoints& closest) noexcept;
    [[nodiscard]] ClosestPoints closest_of(const Meeting& meeting) const noexcept;
    [[nodiscard]] Triangle tool_triangle(PrimId prim) const noexcept;
    [[nodiscard]] Triangle object_triangle(PrimId prim) const noexcept;

    const MeshQuestion& question_;
    Aim aim_;
    std::uint32_t enough_;
    double reach_m_;
    double quantum_m_;
    double doubt_m_;
    MeshReport& report_;
    ContactReport* contacts_;
    bool has_coarse_;                                        ///< Either tree has a coarse face.
    bool leaves_coarse_{false};                              ///< None is looked at.
    std::uint32_t found_{0};                                 ///< Pairs that meet.
    StaticVector<float, kMaxContacts + 1> nearest_contacts_; ///< A heap, the farthest on top.
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
    double share_{static_cast<double>(kProofShare)}; ///< Of the distance, beyond the reach.
    double expected_m_{kInfinity};                   ///< Contacts are within this.
};

} // namespace tactus
