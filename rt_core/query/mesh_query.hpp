// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/mesh_placement.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/mesh_report.hpp"
#include "rt_core/spm/error_code.hpp"

#include <cstdint>
#include <limits>

namespace tactus
{

class AbTree;
class OtherSurface;
struct PairFront;
struct WalkBudget;

/// Value of MeshQuestion::enough that requests all meeting faces.
inline constexpr std::uint32_t kAllMeetingFaces = std::numeric_limits<std::uint32_t>::max();

/// Question about the distance of a mesh tool and an object.
struct MeshQuestion
{
    const AbTree& tool;
    const AbTree& object;
    MeshPlacement place; ///< Placement of the tool's model in the object's frame.
    /// Distance from the tool's faces that matters, in metres of the object's frame.
    double reach_m{0.0};
    /// Distance within which pairs of faces are contacts, in the object's frame; negative: not
    /// requested.
    double contact_m{-1.0};
    /// Farthest contacts in each direction, also slightly beyond the kept ones; null: not
    /// requested.
    ContactEnds* ends{nullptr};
    /// Lower bound on the distance of open faces (coarse and above the tolerance) from the other
    /// model's original surface, in the object's frame; 0: unknown.
    double certified_m{0.0};
    /// Number of meeting pairs that ends the search; above 0.
    std::uint32_t enough{kAllMeetingFaces};
    /// Front that the last query of the same two models kept; null: the search begins at the roots.
    PairFront* front{nullptr};
    /// Largest errors of the tool's and the object's faces that count as the surface; for
    /// query_meshes() only, otherwise 0.
    ErrorCode tool_tolerance{0};
    ErrorCode tolerance{0};

    [[nodiscard]] bool is_tolerant() const noexcept { return (tool_tolerance | tolerance) != 0; }
};

/// Memory of a pair of meshes between queries: the two faces that met or were nearest, and guesses.
/// Any values are safe, as the faces are tested at their present place, and guesses are verified.
struct MeshMemory
{
    FacePair faces;
    /// True if more faces met than contacts fit; the next query expects the same.
    bool exceeds_capacity{false};
    /// Distance of the nearest contacts that did not fit; negative: all fitted.
    double farthest_contact_m{-1.0};
    /// Share of the distance to prove beyond the reach; smaller after a query that was cut.
    double share{static_cast<double>(kProofShare)};

    bool operator==(const MeshMemory&) const noexcept = default;
};

// Each function of this header compares the active faces of two models, in the object's frame. The
// tool's faces are taken as exact where rounding has placed their corners. Single precision with
// proven bounds excludes pairs of faces; the rest is decided exactly. If the budget ends the
// search, the bounds of the answer also hold for the faces that were not visited. Haptic thread.

/// Finds distance, nearest points, meeting faces and contacts.
///
/// L is the least distance of all pairs: less both errors for a pair with a coarse face, and less
/// the kernel's error law for an exact pair. Intersection of faces is decided exactly. If all near
/// pairs are exact, the same pairs are found in any state of the trees. Open faces are left out if
/// the question's `certified_m` is beyond all distances that matter. If `enough` pairs meet, the
/// search ends: L and U are 0, the report has those pairs and is not complete, and contacts are
/// those found until then.
///
/// Pairs with a coarse face within the tolerance are measured like exact ones, may be contacts and
/// count as meeting. Their errors are subtracted from L, U does not follow from them, and the
/// report lists and counts exact pairs only.
///
/// `object` is the object's surface as seen from the tool's model, with the budget of the search.
/// Takes 30 us if 100 pairs meet and no contacts are requested, and 0.2 us if one pair is enough
/// and the last pair still meets.
void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report,
                  ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

/// Finds the least distance and the nearest points, at any range; ignores reach and contacts of
/// `question`. Ends with the first meeting pair, which is then the only one in the report. Exact if
/// no coarse face is nearer. If the budget ends the search, the bounds are those proven until then.
/// `object` is as for query_meshes(). Takes 0.5 us if the last pair still meets, about 30 us near
/// the surface.
void find_nearest_faces(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                        DistanceAnswer& answer, MeshReport& report) noexcept TACTUS_NONBLOCKING;

/// Finds the meeting faces alone; ignores reach and contacts of `question`. Ends if `enough` pairs
/// are found, and the report then is not complete; 1 asks whether any pair meets. Otherwise the
/// report is that of query_meshes(). Takes 0.2 us if the last pair is enough, up to 30 us if
/// nothing meets.
void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
