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
    all,     ///< Distance within the reach, meeting faces and contacts.
    nearest, ///< Distance alone.
    meeting, ///< Meeting faces alone, which needs no measuring.
};

/// Exact faces that share a point.
struct Meeting
{
    MeetingFaces faces;
    PrimId tool_prim{};
    PrimId prim{};
};

/// Order of contacts.
[[nodiscard]] bool comes_before(const MeetingFaces& a,
                                const MeetingFaces& b) noexcept TACTUS_NONBLOCKING;

[[nodiscard]] Triangle placed_triangle(const Triangle& there,
                                       const MeshPlacement& place) noexcept TACTUS_NONBLOCKING;

/// Results of a query of two meshes: distances that still matter, and the final report. Lengths are
/// in the object's frame. Haptic thread.
class MeshFindings // NOLINT(cppcoreguidelines-pro-type-member-init): lists are empty.
{
public:
    /// `doubt_m` is twice the error law of the measuring kernels, for any two faces. `contacts` is
    /// null if not requested. `enough` meeting pairs end the search.
    MeshFindings(const MeshQuestion& question, Aim aim, std::uint32_t enough, double doubt_m,
                 MeshReport& report, ContactReport* contacts) noexcept TACTUS_NONBLOCKING;

    /// Skips contacts that are apart: valid only if exceeds_capacity() in the end.
    void expect_crowd() noexcept { expects_crowd_ = true; }
    /// Sets the share of the distance to prove if nothing is in reach; above 0.
    void prove(double share) noexcept { share_ = share; }
    /// Leaves coarse faces out: the question's `certified_m` is all that is known of them.
    void leave_coarse() noexcept TACTUS_NONBLOCKING;
    /// True if a distance beyond the reach would change nothing.
    [[nodiscard]] bool asks_for_reach_only() const noexcept
    {
        return aim_ == Aim::all && worth_m() <= reach_m_;
    }
    /// Limits the search for contacts to this distance: valid if it holds enough of them.
    void expect_contacts(double within_m) noexcept { expected_m_ = within_m; }
    /// True if it does, or if something else ended the search.
    [[nodiscard]] bool has_expected_contacts() const noexcept TACTUS_NONBLOCKING;
    /// Upper bound on the distance of one contact more than fit; negative if all fit.
    [[nodiscard]] double farthest_contact_m() const noexcept TACTUS_NONBLOCKING;
    /// True if meeting faces leave no capacity for other contacts.
    [[nodiscard]] bool exceeds_capacity() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which faces change nothing. Never grows.
    [[nodiscard]] double worth_m() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which exact pairs need no measuring; negative if none does.
    [[nodiscard]] double measured_m() const noexcept TACTUS_NONBLOCKING;
    /// True if coarse faces may be near enough to matter. Once false it stays false, as the
    /// distance that matters never grows.
    [[nodiscard]] bool needs_coarse() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which no pair is visited, exact or not.
    [[nodiscard]] double walked_m() const noexcept TACTUS_NONBLOCKING;
    /// Distance beyond which pairs are neither the nearest nor kept contacts and could only be
    /// ends.
    [[nodiscard]] double contact_zone_m() const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_enough() const noexcept { return found_ >= enough_; }
    [[nodiscard]] bool has_met() const noexcept { return found_ > 0; }
    /// Upper bound on the distance of some pair, in single precision.
    [[nodiscard]] double bound_m() const noexcept { return bound_m_; }
    /// Lower bound on inexact and unvisited pairs.
    [[nodiscard]] double open_m() const noexcept { return open_m_; }

    /// Lowers bound_m(). False if it was as low already.
    [[nodiscard]] bool try_bound(double upper_m) noexcept
    {
        const bool is_nearer = upper_m < bound_m_;
        bound_m_ = is_nearer ? upper_m : bound_m_;
        return is_nearer;
    }
    /// Records that an unvisited pair is at least this far away.
    void leave(double gap_m) noexcept { open_m_ = std::min(open_m_, gap_m); }
    void take_upper(double upper_m) noexcept TACTUS_NONBLOCKING;
    void add_apart(const MeetingFaces& faces, const Triangle& triangle,
                   const ClosestPoints& closest) noexcept TACTUS_NONBLOCKING;
    void add_meeting(const Meeting& meeting) noexcept TACTUS_NONBLOCKING;
    /// Counts a pair that is at most `upper` apart. If contacts exceed the capacity, the search
    /// skips those beyond all of `nearest_contacts_`.
    void count_contact(float upper) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] DistanceAnswer answer() noexcept TACTUS_NONBLOCKING;
    /// Reports meeting faces, sorted.
    void report_meeting() noexcept TACTUS_NONBLOCKING;
    /// Reports the tool's face of the nearest pair.
    void report_nearest(const DistanceAnswer& answer) noexcept TACTUS_NONBLOCKING;
    /// Reports the contacts in order, and the tool's face of the nearest pair.
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
    bool has_coarse_;                                        ///< A tree has coarse faces.
    bool leaves_coarse_{false};                              ///< Coarse faces are left out.
    std::uint32_t found_{0};                                 ///< Pairs that meet.
    StaticVector<float, kMaxContacts + 1> nearest_contacts_; ///< Heap, the farthest on top.
    double bound_m_{kInfinity};       ///< Upper bound on some pair, in single precision.
    double open_m_{kInfinity};        ///< Lower bound on inexact and unvisited pairs.
    double exact_lower_m_{kInfinity}; ///< Lower bound on exact pairs.
    double upper_m_{kInfinity};       ///< Upper bound on some pair.
    StaticVector<Meeting, kMaxContacts> touching_;
    ClosestPoints nearest_; ///< Nearest exact pair.
    MeetingFaces nearest_faces_;
    bool has_nearest_{false};
    bool has_dropped_{false}; ///< True if a contact did not fit.
    bool expects_crowd_{false};
    double share_{static_cast<double>(kProofShare)}; ///< Share to prove beyond the reach.
    double expected_m_{kInfinity};                   ///< Expected limit of contacts.
};

} // namespace tactus
