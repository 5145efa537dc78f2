// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/contact.hpp"

namespace tactus
{

class AbTree;
class PlacedCore;
struct LocalSurface;

/// Reports the contacts of a tool with a gathered surface, and normal and side at the nearest
/// point, in the model's frame. The same exact faces give the same bits, in any order of `surface`.
///
/// `is_closed`: every edge of the whole mesh has two faces of like winding. If false, no side is
/// reported. Sides follow from angle-weighted pseudonormals (Baerentzen and Aanaes 2005), and are
/// right where the surface does not cross itself.
///
/// Haptic thread. Cost: about 20 ns for each triangle of the surface within the radius, 50 ns to 2
/// us for each that may be among the nearest.
void report_contacts(const PlacedCore& core, double radius_m, const AbTree& tree,
                     const LocalSurface& surface, bool is_closed,
                     ContactReport& report) noexcept TACTUS_NONBLOCKING;

/// Reports possible contacts of a convex tool with a force: nearest points within `reach_m` of the
/// core, and corners of the core over a face. Without the corners, a box flat on a large face would
/// be held at one point. Faces that are neither among the nearest nor an end are not measured.
/// Their slab is a plane between them and the core, with at least 0.95 of their known distance.
void report_touches(const PlacedCore& core, double reach_m, const AbTree& tree,
                    const LocalSurface& surface, TouchReport& touches) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
