// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/surface_faces.hpp"

#include <span>
#include <vector>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Removes vertices of a part of a surface as long as no point of it moves farther than
/// `slack_quanta`, including the moves that the faces report already. A vertex is removed by moving
/// it to a neighbour, so all edges that cancelled before still do, and all vertices stay on the
/// grid. Vertices of `fixed` stay, and those where `faces` don't form one closed fan.
void merge_pieces(std::vector<SurfaceFace>& faces, std::span<const GridPoint> fixed,
                  double slack_quanta);

} // namespace tactus
