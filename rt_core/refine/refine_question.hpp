// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/query/other_surface.hpp"

namespace tactus
{

/// What is known of a question from frame to frame.
struct RefineMemory
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double keep_m{0.0};
    /// No coarse face's distance from the centre minus its error is below this. While it is not
    /// below the reach there is nothing to split, and nobody needs to look.
    double certified_m{0.0};
    bool is_known{false};
    KernelProbe probe{}; ///< Of this frame's centre.
};

/// What one pair asks of a model: every original face within `reach_m` of the point, exactly.
/// Model frame, metres; the centre is not is_beyond_kernels().
///
/// With a surface, of those only the faces within reach_m - span_m of it: the ball of `span_m`
/// holds the surface. Distances, errors taken off, are told as those from the centre all the same,
/// larger by the span than those from the surface.
struct RefineQuestion
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double reach_m{0.0};
    double keep_m{0.0}; ///< Records farther than this may be merged (hysteresis).
    RefineMemory* memory{nullptr};
    OtherSurface* surface{nullptr}; ///< Null for a ball.
    double span_m{0.0};
    double moved_m{0.0};      ///< No point of the surface has moved farther since the last frame.
    double ahead_m{0.0};      ///< How much farther than usual beyond the reach is refined.
    bool counts_errors{true}; ///< Without: coarse faces are wanted by distance alone.
    double tolerance_m{0.0};  ///< Coarse faces with no larger error are not wanted.
};

} // namespace tactus
