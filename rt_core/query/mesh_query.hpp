// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
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
};

/// What a pair of two meshes keeps from one query to the next: where to look first. Any values are
/// safe.
struct MeshMemory
{
    std::uint32_t tool_block{kNoNode}; ///< The blocks of the last nearest or meeting faces.
    std::uint32_t block{kNoNode};

    bool operator==(const MeshMemory&) const noexcept = default;
};

/// Distance, nearest points, meeting faces and contacts of two models' active faces, in the
/// object's frame. Faces of the tool are taken for exact where their corners are placed, each
/// coordinate rounded once or twice.
///
/// L is the least of (distance - both errors) over pairs of faces of which one is coarse, and of
/// the distances of exact pairs lowered by the kernel's law; faces meet by an exact decision. The
/// same pairs are found in whatever state the trees are where all near pairs are exact.
///
/// `object` is the object's surface as the tool's model sees it; its budget bounds the whole
/// search, of which what was not come to lowers L. Haptic thread; 0.1 ms where 100 pairs meet,
/// 0.16 ms where 160 do; some 5 us for each contact of faces that meet.
void query_meshes(const MeshQuestion& question, OtherSurface& object, MeshMemory& memory,
                  DistanceAnswer& answer, MeshReport& report,
                  ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

/// The meeting faces alone: `question`'s reach and contacts don't count. Ends when `enough` pairs
/// are found, of which the report then says that it is not complete; 1 asks whether any meet.
/// Intersection and pairs are else as query_meshes has them. Haptic thread; 1 to 2 us where the
/// blocks that met last are enough, up to 50 us where nothing meets.
void find_meeting_faces(const MeshQuestion& question, std::uint32_t enough, WalkBudget& budget,
                        MeshMemory& memory, MeshReport& report) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
