// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/vec3.hpp"

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
struct RefineQuestion
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double reach_m{0.0};
    double keep_m{0.0}; ///< Records farther than this may be merged; 1.25 x reach (hysteresis).
    RefineMemory* memory{nullptr};
};

} // namespace tactus
