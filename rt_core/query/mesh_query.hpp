// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/mesh_report.hpp"

namespace tactus
{

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
    /// False: where no contacts are wanted either the first pair that meets is enough, and with
    /// contacts kEnoughMeetingFaces are.
    bool wants_pairs{true};
};

/// What a pair of two meshes keeps from one query to the next: the faces that met last, or were the
/// nearest, to be looked at first. They are measured where they are now, so any values are safe.
struct MeshMemory
{
    FacePair faces;
    bool is_crowded{false}; ///< More met than there is room for contacts; so it may be again.

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
/// neither pairs nor contacts are wanted the search ends with the first pair that meets: L and U
/// are 0, and the report has that pair alone and is not complete. With contacts it ends when
/// kEnoughMeetingFaces meet, and contacts are those of what was found.
///
/// `object` is the object's surface as the tool's model sees it, with the budget. 30 us where 100
/// pairs meet and no contacts are asked for; 0.2 us without pairs, where those that met last do.
void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report,
                  ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

/// The least distance and where it is, however far: `question`'s reach and contacts don't count.
/// Ends with the first pair that meets, which the report then has alone. Exact where no coarse face
/// is nearer; where the budget ends the search, a bracket of what was proven until then. `object`
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
