// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

namespace tactus
{

/// A triangle relative to a query point, in double precision: its corners and edges (edge i joins
/// corners i and i + 1) and the nearest point of each edge, the foot. One column each; the fourth
/// column may be written, too. 480 B.
struct SeenTriangle
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): for the kernels.
    alignas(32) double corner[3][4]; ///< Rows x, y, z, like those of `edge` and `foot`.
    double edge[3][4];
    double foot[3][4];
    double corner_sq[4]; ///< Squared lengths, as in the two below.
    double edge_sq[4];
    double foot_sq[4];
    double parameter[4]; ///< Position of the foot on its edge, 0 to 1.
    double normal[4];    ///< Edge 0 x edge 1; x, y, z.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
    bool is_inside; ///< True if the query point lies over the triangle along that normal.
};
static_assert(sizeof(SeenTriangle) == 480);

/// Computes a triangle (nine coordinates) as seen from a point (three). Coordinates lie between
/// 2^-130 and 2^130. A kernel set may have a faster version with the same bits.
void see_triangle(const double* query, const double* triangle,
                  SeenTriangle& seen) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
