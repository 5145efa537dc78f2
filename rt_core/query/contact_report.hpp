// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/local_surface.hpp"

namespace tactus
{

/// The contacts of a tool with a surface that was gathered from its core, and normal and side at
/// the nearest point, in the model's frame. Does not depend on the traversal: where the same faces
/// are exact it gives the same bits.
///
/// `is_closed` says that every edge of the whole mesh has two faces of like winding; without it
/// there is no side. Signs by angle-weighted pseudonormals: Baerentzen and Aanaes 2005. They are
/// right where the surface does not cross itself.
///
/// Haptic thread; cost: some 20 ns for each triangle of the surface within the radius, 50 ns to 2
/// us for each that may be among the nearest.
void report_contacts(const PlacedCore& core, double radius_m, const AbTree& tree,
                     const LocalSurface& surface, bool is_closed,
                     ContactReport& report) noexcept TACTUS_NONBLOCKING;

/// Where a convex tool with a force may come to touch that surface: nearest points within `reach_m`
/// of the core, and its corners that stand over a face, without which a box that lies flat on a
/// large face would be held at one point alone. Which points are nearest among many as near is
/// left to the kernel. Faces that are neither among the nearest nor an end are not measured: their
/// slab is that of a plane between them and the core, at least 0.95 of their distance away as it is
/// known from the surface.
void report_touches(const PlacedCore& core, double reach_m, const AbTree& tree,
                    const LocalSurface& surface, TouchReport& touches) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
