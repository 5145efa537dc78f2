// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/query/pair_front.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/mesh_report.hpp"

#include <cstdint>
#include <limits>

namespace tactus
{

/// Value of MeshQuestion::enough that requests all meeting faces.
inline constexpr std::uint32_t kAllMeetingFaces = std::numeric_limits<std::uint32_t>::max();

/// Question about a mesh tool and an object.
struct MeshQuestion
{
    const AbTree& tool;
    const AbTree& object;
    MeshPlacement place;    ///< Placement of the tool's model in the object's.
    double reach_m{0.0};    ///< Reach from the tool's faces; in the object's frame, like the
                            ///< radius.
    double contact_m{-1.0}; ///< Distance within which pairs of faces are contacts; negative: not
                            ///< requested.
    /// Extreme contacts just beyond the kept ones; null: not requested.
    ContactEnds* ends{nullptr};
    /// Lower bound on the distance of inexact faces from the other's original surface, in the
    /// object's frame; 0: unknown.
    double certified_m{0.0};
    /// Number of meeting pairs that ends the search; above 0.
    std::uint32_t enough{kAllMeetingFaces};
    /// Front of the last query of the same two models; null: every query begins at the roots.
    PairFront* front{nullptr};
};

/// Memory of a pair of meshes between queries: the faces that met last or were the nearest, the
/// distance of contacts and the provable share. The faces are tested first, at their present place.
/// The other members are guesses that are tested. Any values are safe.
struct MeshMemory
{
    FacePair faces;
    bool exceeds_capacity{false}; ///< True if more faces met than contacts fit, which may repeat.
    /// Distance of the nearest contacts that did not fit; negative: all fitted.
    double farthest_contact_m{-1.0};
    /// Share of the distance requested beyond the reach; smaller after a query that was cut.
    double share{static_cast<double>(kProofShare)};

    bool operator==(const MeshMemory&) const noexcept = default;
};

// Three questions about two models' active faces, in the object's frame. Faces of the tool count as
// exact at their placed corners, each coordinate rounded once or twice. Single precision with
// proven bands sorts out pairs of faces. Open cases are decided exactly. Budgets bound the whole
// search, and the answer reports unvisited parts. Haptic thread.

/// Finds distance, nearest points, meeting faces and contacts.
///
/// L is the least of two terms: (distance - both errors) over pairs with a coarse face, and the
/// distances of exact pairs lowered by the kernel's law. Intersection of faces is decided exactly.
/// If all near pairs are exact, the same pairs are found in any state of the trees. Coarse faces
/// are left out if the question's `certified_m` is beyond all that matters. If `enough` pairs meet,
/// the search ends: L and U are 0, the report has those pairs and is not complete, and contacts are
/// those found until then.
///
/// `object` is the object's surface as seen from the tool's model, with the budget. Takes 30 us if
/// 100 pairs meet and no contacts are requested. Takes 0.2 us if one pair is enough and the last
/// one still meets.
void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report,
                  ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

/// Finds the least distance and its place, however far; ignores `question`'s reach and contacts.
/// Ends with the first meeting pair, which is then the only one in the report. Exact if no coarse
/// face is nearer. If the budget ends the search, the bounds are those proven until then. `object`
/// as above. Takes 0.5 us if the last faces still meet, about 30 us near the surface.
void find_nearest_faces(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                        DistanceAnswer& answer, MeshReport& report) noexcept TACTUS_NONBLOCKING;

/// Finds the meeting faces alone; ignores `question`'s reach and contacts. Ends if `enough` pairs
/// are found, and the report then states that it is not complete; 1 asks whether any meet.
/// Intersection and pairs are otherwise those of query_meshes. Takes 0.2 us if the last faces are
/// enough, up to 30 us if nothing meets.
void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
