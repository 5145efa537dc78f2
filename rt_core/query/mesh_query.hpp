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

/// Distance, nearest points, meeting faces and contacts of two models' active faces, in the
/// object's frame. Faces of the tool are taken for exact where their corners are placed, each
/// coordinate rounded once or twice.
///
/// L is the least of (distance - both errors) over pairs of faces of which one is coarse, and of
/// the distances of exact pairs lowered by the kernel's law; faces meet by an exact decision. The
/// same pairs are found in whatever state the trees are where all near pairs are exact.
///
/// `object` is the object's surface as the tool's model sees it; its budget bounds the whole
/// search, of which what was not come to lowers L. `memory` is of the tool's tree. Haptic thread;
/// 0.94 ms where 160 pairs meet and contacts are wanted.
void query_meshes(const MeshQuestion& question, OtherSurface& object, QueryMemory& memory,
                  DistanceAnswer& answer, MeshReport& report,
                  ContactReport& contacts) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
