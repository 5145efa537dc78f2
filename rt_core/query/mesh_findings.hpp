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

/// Purpose of a search.
enum class Aim : std::uint8_t
{
    all,     ///< The search finds the distance within the reach, meeting faces and contacts.
    nearest, ///< The search finds the distance alone.
    meeting, ///< The search finds meeting faces alone, which needs no measuring.
};

/// Two faces that count as the surface and share a point.
struct Meeting
{
    MeetingFaces faces;
    PrimId tool_prim{};
    PrimId prim{};
};

/// Order of contacts: by the object's face, then the tool's.
[[nodiscard]] bool comes_before(const MeetingFaces& a,
                                const MeetingFaces& b) noexcept TACTUS_NONBLOCKING;

/// Upper bound on the distance of two faces' nearest corners. Corners of coarse faces are original
/// vertices, too.
[[nodiscard]] double corners_apart(const Triangle& a,
                                   const Triangle& b) noexcept TACTUS_NONBLOCKING;

[[nodiscard]] Triangle placed_triangle(const Triangle& there,
                                       const MeshPlacement& place) noexcept TACTUS_NONBLOCKING;

/// Results of a query of two meshes: the distances that still matter during the search, and the
/// reports. Lengths are in the object's frame. Haptic thread.
class MeshFindings // NOLINT(cppcoreguidelines-pro-type-member-init): lists are empty.
{
public:
    /// `doubt_m` is twice the error law of the measuring kernels, for any two faces. `contacts` is
    /// null if not requested. `enough` meeting pairs end the search; above 0.
    MeshFindings(const MeshQuestion& question, Aim aim, std::uint32_t enough, double doubt_m,
                 MeshReport& report, ContactReport* contacts) noexcept TACTUS_NONBLOCKING;

    /// Skips contacts between separate faces: valid only if exceeds_capacity() is true in the end.
    void expect_exceeded_capacity() noexcept { expects_exceeded_capacity_ = true; }
    /// Sets the share of the distance, above 0, that is to be proven if nothing is in reach.
    void prove(double share) noexcept { share_ = share; }
    /// Leaves open faces out: they count as `certified_m` of the question away.
    void leave_open() noexcept TACTUS_NONBLOCKING;
    /// True if no distance beyond the reach is to be proven.
    [[nodiscard]] bool asks_for_reach_only() const noexcept
    {
        return aim_ == Aim::all && worth_m() <= looked_m_;
    }
    /// Limits the search for contacts to `within_m`: valid only if has_expected_contacts() in the
    /// end.
    void expect_contacts(double within_m) noexcept { expected_m_ = within_m; }
    /// True if the limit of expect_contacts() left out no contact that would be kept.
    [[nodiscard]] bool has_expected_contacts() const noexcept TACTUS_NONBLOCKING;
    /// Bound on the distance of the nearest contact that did not fit; negative if all fit.
    [[nodiscard]] double farthest_contact_m() const noexcept TACTUS_NONBLOCKING;
    /// True if meeting faces alone exceed the capacity for contacts.
    [[nodiscard]] bool exceeds_capacity() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which faces change no result. Never grows.
    [[nodiscard]] double worth_m() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which pairs that count as the surface need no measuring; negative if no pair
    /// does.
    [[nodiscard]] double measured_m() const noexcept TACTUS_NONBLOCKING;
    /// True if open faces may be near enough to matter. Once false it stays false, as worth_m()
    /// never grows.
    [[nodiscard]] bool needs_open() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which no pair of faces is visited.
    [[nodiscard]] double walked_m() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which pairs are neither nearest nor kept contacts, and could only be ends.
    [[nodiscard]] double contact_zone_m() const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_enough() const noexcept { return found_ >= enough_; }
    [[nodiscard]] bool has_met() const noexcept { return found_ > 0; }
    /// Upper bound on the distance of the two surfaces as they are active, in single precision.
    [[nodiscard]] double bound_m() const noexcept { return bound_m_; }
    /// Lower bound on the distance of open and unvisited pairs.
    [[nodiscard]] double open_m() const noexcept { return open_m_; }

    /// Lowers bound_m() to `upper_m`. False if it was as low already. `is_of_source` is true if the
    /// original surfaces are as near, too.
    [[nodiscard]] bool try_bound(double upper_m, bool is_of_source) noexcept
    {
        const bool is_nearer = upper_m < bound_m_;
        bound_m_ = is_nearer ? upper_m : bound_m_;
        upper_m_ = is_of_source ? std::min(upper_m_, upper_m) : upper_m_;
        return is_nearer;
    }
    /// Records that a pair within the tolerance is at least `gap_m` apart; its error is subtracted.
    void tolerate(double gap_m, double error_m) noexcept
    {
        tolerated_lower_m_ = std::min(tolerated_lower_m_, gap_m - error_m);
        tolerated_m_ = std::max(tolerated_m_, error_m);
    }
    /// Records that an unvisited pair is at least `gap_m` away.
    void leave(double gap_m) noexcept { open_m_ = std::min(open_m_, gap_m); }
    void take_upper(double upper_m) noexcept TACTUS_NONBLOCKING;
    /// Adds a measured pair, or one that meets. `error_m` is the error of its coarse faces; 0 if
    /// both are exact.
    void add_apart(const MeetingFaces& faces, const Triangle& triangle,
                   const ClosestPoints& closest, double error_m) noexcept TACTUS_NONBLOCKING;
    void add_meeting(const Meeting& meeting, double error_m) noexcept TACTUS_NONBLOCKING;
    /// Counts a pair that is at most `upper` quanta apart as a contact. If contacts exceed the
    /// capacity, the search skips pairs farther than all of `nearest_contacts_`.
    void count_contact(float upper) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] DistanceAnswer answer() noexcept TACTUS_NONBLOCKING;
    /// Completes the report of meeting faces, sorted.
    void report_meeting() noexcept TACTUS_NONBLOCKING;
    /// Reports the face of the tool in the nearest pair.
    void report_nearest(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;
    /// Reports the contacts in order, and the face of the tool in the nearest pair.
    void report_contacts(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] bool is_left_open() const noexcept;
    [[nodiscard]] bool knows_nearest() const noexcept;
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
    /// Reach plus the tolerance: the surface that a face stands for may be nearer by that.
    double looked_m_;
    double quantum_m_;
    double doubt_m_;
    MeshReport& report_;
    ContactReport* contacts_;
    bool has_coarse_;         ///< True if one of the trees has coarse faces.
    bool leaves_open_{false}; ///< True if open faces are left out.
    std::uint32_t found_{0};  ///< Number of pairs that meet.
    /// Upper bounds on the nearest contacts, in quanta; a heap, the farthest on top.
    StaticVector<float, kMaxContacts + 1> nearest_contacts_;
    double bound_m_{kInfinity};       ///< Bound as for bound_m().
    double open_m_{kInfinity};        ///< Bound on open and unvisited pairs, as for open_m().
    double exact_lower_m_{kInfinity}; ///< Lower bound on the distance of exact pairs.
    /// Lower bound on the distance of the surface that pairs within the tolerance stand for.
    double tolerated_lower_m_{kInfinity};
    double tolerated_m_{0.0};   ///< Largest error of such pairs.
    double upper_m_{kInfinity}; ///< Upper bound on the original surfaces' distance.
    StaticVector<Meeting, kMaxContacts> touching_;
    ClosestPoints nearest_; ///< Nearest measured pair.
    MeetingFaces nearest_faces_;
    bool has_nearest_{false};
    bool has_dropped_{false}; ///< True if a contact did not fit.
    bool expects_exceeded_capacity_{false};
    /// Share of the distance to prove if nothing is in reach.
    double share_{static_cast<double>(kProofShare)};
    double expected_m_{kInfinity}; ///< Limit set by expect_contacts().
};

} // namespace tactus
