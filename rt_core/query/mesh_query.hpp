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

/// MeshQuestion::enough of one that asks for all.
inline constexpr std::uint32_t kAllMeetingFaces = std::numeric_limits<std::uint32_t>::max();

/// A tool that is a mesh, and an object: what is asked of the two.
struct MeshQuestion
{
    const AbTree& tool;
    const AbTree& object;
    MeshPlacement place;    ///< Of the tool's model in the object's.
    double reach_m{0.0};    ///< From the tool's faces; in the object's frame, as the radius.
    double contact_m{-1.0}; ///< Pairs of faces this near are contacts; negative: none are wanted.
    /// Of contacts that are little farther than those there is room for, too; null: not wanted.
    ContactEnds* ends{nullptr};
    /// What is not exact is known to be at least this far from the other's original surface, in the
    /// object's frame; 0: nothing is known of it.
    double certified_m{0.0};
    /// So many pairs that meet end the search; more than 0.
    std::uint32_t enough{kAllMeetingFaces};
    /// What the last query of the same two models came to; null: every query begins at the roots.
    PairFront* front{nullptr};
};

/// What a pair of two meshes keeps from one query to the next: the faces that met last, or were the
/// nearest, to be looked at first, how far contacts went and how much of a distance can be proven.
/// The first are measured where they are now, the others are guesses that are tested: any values
/// are safe.
struct MeshMemory
{
    FacePair faces;
    bool exceeds_capacity{false}; ///< More met than there is room for contacts; so it may be again.
    /// The nearest contacts for which there was no room were as near; negative: there was room.
    double farthest_contact_m{-1.0};
    /// Beyond the reach, so much of the distance is asked for: less after a query that was cut.
    double share{static_cast<double>(kProofShare)};

    bool operator==(const MeshMemory&) const noexcept = default;
};

// Three questions of two models' active faces, in the object's frame. Faces of the tool are taken
// for exact where their corners are placed, each coordinate rounded once or twice. Single precision
// sorts out pairs of faces, with proven bands; what it leaves open is decided exactly. Budgets
// bound the whole search, and what was not come to is told by the answer. Haptic thread.

/// Distance, nearest points, meeting faces and contacts.
///
/// L is the least of (distance - both errors) over pairs of faces of which one is coarse, and of
/// the distances of exact pairs lowered by the kernel's law; faces meet by an exact decision. The
/// same pairs are found in whatever state the trees are where all near pairs are exact. Coarse
/// faces are not looked at where the question's `certified_m` is beyond all that matters. Where
/// `enough` pairs are found to meet the search ends: L and U are 0, the report has those pairs and
/// is not complete, and contacts are those of what was found.
///
/// `object` is the object's surface as the tool's model sees it, with the budget. 30 us where 100
/// pairs meet and no contacts are asked for; 0.2 us where one is enough and those that met last do.
void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report,
                  ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

/// The least distance and where it is, however far: `question`'s reach and contacts don't count.
/// Ends with the first pair that meets, which the report then has alone. Exact where no coarse face
/// is nearer; where the budget ends the search, bounds of what was proven until then. `object`
/// as above. 0.5 us where the faces that met last still do, some 30 us near the surface.
void find_nearest_faces(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                        DistanceAnswer& answer, MeshReport& report) noexcept TACTUS_NONBLOCKING;

/// The meeting faces alone: `question`'s reach and contacts don't count. Ends when `enough` pairs
/// are found, of which the report then says that it is not complete; 1 asks whether any meet.
/// Intersection and pairs are else as query_meshes has them. 0.2 us where the faces that met last
/// are enough, up to 30 us where nothing meets.
void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
