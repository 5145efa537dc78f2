// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

namespace tactus
{

/// A triangle relative to a query point, in double precision: its corners and edges (edge i joins
/// corners i and i + 1) and the nearest point of each edge. A column each; the fourth may be
/// written, too. 480 B.
struct SeenTriangle
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): for the kernels.
    alignas(32) double corner[3][4]; ///< Rows x, y, z, as of edges and feet.
    double edge[3][4];
    double foot[3][4];
    double corner_sq[4]; ///< Squared lengths,
    double edge_sq[4];
    double foot_sq[4];
    double parameter[4]; ///< and where on its edge a foot lies, 0 to 1.
    double normal[4];    ///< Edge 0 x edge 1; x, y, z.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
    bool is_inside; ///< The query point lies over the triangle, by that normal.
};
static_assert(sizeof(SeenTriangle) == 480);

/// Looks at a triangle, nine coordinates, from a point, three. Of coordinates between 2^-130 and
/// 2^130; a kernel set may have a faster one with the same bits.
void see_triangle(const double* query, const double* triangle,
                  SeenTriangle& seen) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
